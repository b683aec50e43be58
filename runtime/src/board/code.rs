//! The kind of code that a program holds: bytecode, or code of the real processor.

use kmotiondef::GuestAddr;
use kmotiondef::firmware::Function;
use vm::dsp;
use vm::loaded::{Image, LoadedCode as Code};
use vm::verify::{VerifyError, VerifyErrorKind, verify_image};

use crate::firmware::level::ModelledBoard;

/// Bytecode in a text that begins at `base`.
///
/// # Errors
/// The rule that it breaks.
pub(super) fn program(bytes: &[u8], base: GuestAddr) -> Result<Code, VerifyError> {
    verify_image(bytes, base).map(|program| Code::Program(program.into()))
}

/// Code of the real processor, `length` bytes from `base` on, and the addresses of its functions; `board` executes it.
pub(super) fn image(base: GuestAddr, length: u32, functions: Vec<u32>, board: &ModelledBoard) -> Code {
    let image = Image::new(base..base.offset(length), thread_done(board));
    Code::Image(image.with_functions(functions).into())
}

/// Code of either kind that was downloaded without an image.
///
/// # Errors
/// The reason why it is not valid bytecode, if the real processor could not execute it either.
pub(super) fn code_without_image(
    bytes: &[u8],
    base: GuestAddr,
    board: &ModelledBoard,
) -> Result<Code, VerifyError> {
    match program(bytes, base) {
        Err(VerifyError { kind: VerifyErrorKind::NotAProgram, .. }) if dsp::is_code(bytes) => {
            // The border between code and data is unknown, so nothing is protected.
            let code = base..base.offset(bytes.len() as u32);
            Ok(Code::Image(Image::unprotected(code, thread_done(board)).into()))
        }
        other => other,
    }
}

/// The address to which a thread's outermost function returns.
fn thread_done(board: &ModelledBoard) -> GuestAddr {
    board.address(Function::ThreadDone.name()).unwrap_or(Function::ThreadDone.row().address)
}
