//! Turns the bytes of a text into a [`Program`]: an image is not trusted.
//!
//! A program that passes cannot leave its registers, its constants or its code, passes arguments as its callees expect
//! them, and charges its cost ([`meter`](crate::meter)). What depends on values (addresses, pointers to functions,
//! divisors, depth of calls) is checked where it happens. Reading a register that was never written yields 0.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]
#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::as_conversions
    )
)]

mod body;

use std::ops::Range;

use kmotiondef::GuestAddr;

use self::body::check_body;
use crate::firmware::Signature;
use crate::guard;
use crate::op::{Op, VERSION, WORD};
use crate::operand::{Class, Classes, Count, FuncRef, SigRef};
use crate::program::{Function, MAX_TEXT, Program};

/// Most parameters of a function.
pub const MAX_PARAMETERS: usize = 255;

/// The limit of registers in a function, so that the arguments of its calls fit after them.
pub const MAX_REGISTERS: usize = 0xff00;

/// Classes in one `types` word.
const CLASSES_PER_WORD: usize = 16;

/// The error for a text that was refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("word {at}: {kind}")]
pub struct VerifyError {
    /// Index of the word in the text.
    pub at: usize,
    /// The kind of error.
    pub kind: VerifyErrorKind,
}

/// A kind of error in a word of a text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum VerifyErrorKind {
    /// The size is not a multiple of the word, or the address is not.
    #[error("the text does not consist of whole words of {WORD} bytes at a multiple of {WORD}")]
    NotWords,
    /// The text does not begin with a `program` word.
    #[error("the text is not bytecode")]
    NotAProgram,
    /// The text does not begin with the words that make a real processor return at once.
    #[error(
        "the text begins with bytecode, where a real processor would begin to execute it; build it again"
    )]
    Unguarded,
    /// The text gives an address for `main` at which no function begins.
    #[error("no function is at {0}, where `main` should be")]
    Main(GuestAddr),
    /// The bytecode is of another version.
    #[error("the text is bytecode of version {0}, this machine runs version {VERSION}")]
    Version(u16),
    /// The text ends too early.
    #[error("the text is truncated")]
    Truncated,
    /// No instruction has this encoding.
    #[error("not an instruction")]
    UnknownInstruction,
    /// A `program`, `sig`, `func` or `types` word is where it cannot be.
    #[error("`{0}` is not allowed here")]
    Misplaced(&'static str),
    /// A signature or function states more than the machine can hold.
    #[error("{0} is beyond the limit of {1}")]
    TooMany(&'static str, usize),
    /// The result class of a signature is none.
    #[error("a result class of {0} does not exist")]
    ResultClass(u16),
    /// The first registers of a function differ from the parameters of its signature.
    #[error("the function's first registers are not the parameters of its signature")]
    Parameters,
    /// A function has no instruction.
    #[error("the function is empty")]
    EmptyFunction,
    /// An operand names a register that the function does not have.
    #[error("the function has no register {0}")]
    NoRegister(u16),
    /// An operand names a register of another class.
    #[error("register {0} holds {1}, not {2}")]
    RegisterClass(u16, Class, Class),
    /// An operand names a constant beyond the pool.
    #[error("the pool has no constant {0}")]
    NoConstant(u32),
    /// An operand names a signature that does not exist.
    #[error("the program has no signature {0}")]
    NoSignature(u16),
    /// An operand names a word that does not open a function.
    #[error("no function starts at word {0}")]
    NoFunction(u32),
    /// A branch leaves its function or enters the middle of a call or table.
    #[error("word {0} cannot be the target of a branch here")]
    BadLabel(u32),
    /// An argument does not follow the previous one, or is not followed by a call.
    #[error("the arguments of a call must be in order directly before it")]
    Arguments,
    /// The arguments of a call do not match its signature.
    #[error("the arguments of the call are not those of its signature")]
    ArgumentClasses,
    /// A result is taken without a call with such a result directly before it.
    #[error("no call with this class of result stands directly before")]
    Result,
    /// A `br_table` is not followed by its branches.
    #[error("the table must be followed by {0} `br` words")]
    Table(usize),
    /// A return has another class than the signature.
    #[error("the return is not that of the function's signature")]
    ReturnClass,
    /// The last instruction of a function continues after it.
    #[error("the function continues after its end")]
    FallsOff,
    /// A function, or an iteration of a loop, has no charge.
    #[error("the code from here on can run forever without being charged")]
    Uncharged,
}

/// Verifies the text of an image, which begins at `start` with the words of [`guard`].
///
/// # Errors
/// The first error found.
pub fn verify_image(text: &[u8], start: GuestAddr) -> Result<Program, VerifyError> {
    let fail = |kind| VerifyError { at: 0, kind };
    let Some((main, code)) = guard::split(text) else {
        let is_bare = read_head(text.as_chunks().0).is_ok();
        return Err(fail(if is_bare { VerifyErrorKind::Unguarded } else { VerifyErrorKind::NotAProgram }));
    };
    let mut program = verify(code, guard::code_at(start))?;
    program.function_at(main).ok_or_else(|| fail(VerifyErrorKind::Main(main)))?;
    program.main = Some(main);
    Ok(program)
}

/// Verifies the bytecode that is at `base`.
///
/// # Errors
/// The first error found.
pub fn verify(text: &[u8], base: GuestAddr) -> Result<Program, VerifyError> {
    let (words, rest) = text.as_chunks::<WORD>();
    if !rest.is_empty() || !base.get().is_multiple_of(8) || text.len() > MAX_TEXT {
        return Err(VerifyError { at: words.len(), kind: VerifyErrorKind::NotWords });
    }
    let pool_size = read_head(words).map_err(|kind| VerifyError { at: 0, kind })?;
    let pool = words
        .get(1..=pool_size)
        .ok_or(VerifyError { at: words.len(), kind: VerifyErrorKind::Truncated })?
        .iter()
        .map(|word| u64::from_le_bytes(*word))
        .collect();
    let mut program = Program {
        base: base.get(),
        main: None,
        ops: decode(words, pool_size)?,
        pool,
        signatures: Vec::new(),
        functions: Vec::new(),
    };
    let mut reader = Reader { ops: &program.ops, at: 1 + pool_size };
    let signatures = reader.signatures()?;
    let functions = reader.functions(&signatures)?;
    program.signatures = signatures;
    program.functions = functions;
    for function in &program.functions {
        check_body(&program, function)?;
    }
    Ok(program)
}

/// Checks the `program` word and yields the size of the pool.
fn read_head(words: &[[u8; WORD]]) -> Result<usize, VerifyErrorKind> {
    let Some(Op::Program { version, pool }) = words.first().and_then(|word| Op::decode(*word)) else {
        return Err(VerifyErrorKind::NotAProgram);
    };
    if version.0 != VERSION {
        return Err(VerifyErrorKind::Version(version.0));
    }
    usize::try_from(pool.0).map_err(|_| VerifyErrorKind::Truncated)
}

/// Decodes every word that is not of the pool.
fn decode(words: &[[u8; WORD]], pool_size: usize) -> Result<Vec<Op>, VerifyError> {
    let is_constant = |at| (1..=pool_size).contains(&at);
    let decode = |(at, word): (usize, &[u8; WORD])| match Op::decode(*word) {
        _ if is_constant(at) => Ok(Op::Unreachable {}),
        Some(op) => Ok(op),
        None => Err(VerifyError { at, kind: VerifyErrorKind::UnknownInstruction }),
    };
    words.iter().enumerate().map(decode).collect()
}

/// Reads the words after the pool in their order.
struct Reader<'a> {
    ops: &'a [Op],
    at: usize,
}

impl Reader<'_> {
    fn signatures(&mut self) -> Result<Vec<Signature>, VerifyError> {
        let mut signatures = Vec::new();
        while let Some(Op::Sig { params, ret }) = self.ops.get(self.at) {
            let at = self.at;
            let fail = |kind| Err(VerifyError { at, kind });
            if usize::from(params.0) > MAX_PARAMETERS {
                return fail(VerifyErrorKind::TooMany("the number of parameters", MAX_PARAMETERS));
            }
            let result = match ret.0 {
                0 => None,
                code => match Class::ALL.get(usize::from(code) - 1) {
                    Some(class) => Some(*class),
                    None => return fail(VerifyErrorKind::ResultClass(code)),
                },
            };
            self.at += 1;
            signatures.push(Signature { params: self.classes(*params)?, result });
        }
        Ok(signatures)
    }

    fn functions(&mut self, signatures: &[Signature]) -> Result<Vec<Function>, VerifyError> {
        let mut functions = Vec::new();
        while let Some(op) = self.ops.get(self.at) {
            let at = self.at;
            let fail = |kind| Err(VerifyError { at, kind });
            let Op::Func { sig, regs, frame } = *op else {
                return fail(VerifyErrorKind::Misplaced(op.name()));
            };
            if usize::from(regs.0) > MAX_REGISTERS {
                return fail(VerifyErrorKind::TooMany("the number of registers", MAX_REGISTERS));
            }
            let Some(signature) = signatures.get(usize::from(sig.0)) else {
                return fail(VerifyErrorKind::NoSignature(sig.0));
            };
            self.at += 1;
            let classes = self.classes(regs)?;
            if !classes.starts_with(&signature.params) {
                return fail(VerifyErrorKind::Parameters);
            }
            let body = self.body();
            if body.is_empty() {
                return fail(VerifyErrorKind::EmptyFunction);
            }
            let at = FuncRef(u32::try_from(at).unwrap_or(u32::MAX));
            functions.push(Function { at, body, signature: sig, classes, frame: u32::from(frame.0) * 8 });
        }
        Ok(functions)
    }

    /// Reads the `types` words of `count` registers.
    fn classes(&mut self, count: Count) -> Result<Vec<Class>, VerifyError> {
        let count = usize::from(count.0);
        let mut classes = Vec::with_capacity(count);
        while classes.len() < count {
            let fail = |kind| Err(VerifyError { at: self.at, kind });
            let types = match self.ops.get(self.at) {
                Some(Op::Types { classes }) => *classes,
                Some(op) => return fail(VerifyErrorKind::Misplaced(op.name())),
                None => return fail(VerifyErrorKind::Truncated),
            };
            classes.extend(unpack(types).take(count - classes.len()));
            self.at += 1;
        }
        Ok(classes)
    }

    /// Passes over the words up to the next function.
    fn body(&mut self) -> Range<usize> {
        let start = self.at;
        let rest = self.ops.get(start..).unwrap_or_default();
        self.at += rest.iter().take_while(|op| !matches!(op, Op::Func { .. })).count();
        start..self.at
    }
}

/// The classes of a `types` word.
fn unpack(types: Classes) -> impl Iterator<Item = Class> {
    (0..CLASSES_PER_WORD).map(move |index| {
        let [code, ..] = (types.0 >> (2 * index)).to_le_bytes();
        Class::from_code(code)
    })
}

/// The signature `sig` of `program`.
fn signature(program: &Program, sig: SigRef) -> Result<&Signature, VerifyErrorKind> {
    program.signatures.get(usize::from(sig.0)).ok_or(VerifyErrorKind::NoSignature(sig.0))
}

#[cfg(test)]
mod tests;
