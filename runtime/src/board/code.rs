//! What the bytes of a program are: bytecode, or code of the real processor.

use kmotiondef::GuestAddr;
use kmotiondef::firmware::Function;
use vm::dsp;
use vm::loaded::{Image, Loaded as Code};
use vm::verify::{VerifyError, VerifyErrorKind, verify_image};

/// Where a thread's outermost function returns to.
const THREAD_DONE: GuestAddr = Function::ThreadDone.row().address;

/// Bytecode in a text that begins at `base`.
///
/// # Errors
/// The rule that it breaks.
pub(super) fn program(bytes: &[u8], base: GuestAddr) -> Result<Code, VerifyError> {
    verify_image(bytes, base).map(|program| Code::Program(program.into()))
}

/// Code of the real processor, `length` bytes from `base` on, and where its functions begin.
pub(super) fn image(base: GuestAddr, length: u32, functions: Vec<u32>) -> Code {
    let image = Image::new(base..base.offset(length), THREAD_DONE);
    Code::Image(image.with_functions(functions).into())
}

/// Code of whatever kind that came without an image around it.
///
/// # Errors
/// The rule that it breaks as bytecode, if the real processor could not execute it either.
pub(super) fn bare(bytes: &[u8], base: GuestAddr) -> Result<Code, VerifyError> {
    match program(bytes, base) {
        Err(VerifyError { kind: VerifyErrorKind::NotAProgram, .. }) if dsp::is_code(bytes) => {
            // Where the code ends and the data begins is not known: nothing is protected.
            let code = base..base.offset(bytes.len() as u32);
            Ok(Code::Image(Image::unprotected(code, THREAD_DONE).into()))
        }
        other => other,
    }
}
