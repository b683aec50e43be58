//! A verified program: what the loader hands to the machine.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

use std::ops::Range;

use kmotiondef::map::{PROGRAM_BASE, PROGRAM_LIMIT};
use kmotiondef::{CodeAddr, Cycles, GuestAddr};

use crate::firmware::{Pure, Signature};
use crate::guard;
use crate::kind::OpKind;
use crate::meter;
use crate::op::{Op, WORD};
use crate::operand::{Class, FuncRef, SigRef};

/// Most bytes of a text: the whole program area.
pub(crate) const MAX_TEXT: usize = (PROGRAM_LIMIT - PROGRAM_BASE) as usize;

/// Index of the first executable word of a function with `registers`: after its `func` and `types` words.
#[inline]
pub(crate) fn body_of(function: FuncRef, registers: u16) -> usize {
    function.0 as usize + 1 + usize::from(registers).div_ceil(16)
}

/// A function of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Index of its `func` word.
    pub at: FuncRef,
    /// Its executable words: after the `types` words, up to the next function.
    pub body: Range<usize>,
    /// Its signature.
    pub signature: SigRef,
    /// Class of each register; the parameters come first.
    pub classes: Vec<Class>,
    /// Bytes of its frame in guest memory.
    pub frame: u32,
}

/// A program that an engine can run without further checks.
///
/// Made by [`verify`](crate::verify::verify) only. Instructions are addressed by the index of their word in the text.
/// It is pure data: the engine keeps its translations ([`Translations`](crate::translations::Translations)).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    pub(crate) base: u32,
    /// Address of `main`, where the text begins with the words of [`guard`](crate::guard).
    pub(crate) main: Option<GuestAddr>,
    /// The instruction of each word of the text; [`Op::Unreachable`] for a word of the pool.
    pub(crate) ops: Vec<Op>,
    pub(crate) pool: Vec<u64>,
    pub(crate) signatures: Vec<Signature>,
    pub(crate) functions: Vec<Function>,
}

impl Program {
    /// The address of the first word of the bytecode.
    #[must_use]
    pub const fn base(&self) -> GuestAddr {
        GuestAddr::new(self.base)
    }

    /// The guest addresses of the text, with the words before the bytecode.
    #[must_use]
    pub fn text(&self) -> Range<GuestAddr> {
        let bytes = (self.ops.len() * WORD) as u32;
        self.start()..self.base().offset(bytes)
    }

    /// The start address of the text.
    const fn start(&self) -> GuestAddr {
        let guard = if self.main.is_some() { guard::BYTES as u32 } else { 0 };
        GuestAddr::new(self.base.wrapping_sub(guard))
    }

    /// The address of `main`, if the image gives it.
    #[must_use]
    pub const fn main(&self) -> Option<GuestAddr> {
        self.main
    }

    /// The instructions, by index of their word.
    #[must_use]
    pub fn ops(&self) -> &[Op] {
        &self.ops
    }

    /// Returns the program with all costs between firmware calls multiplied by `factor`.
    ///
    /// A segment costs at least one cycle, and at most the largest count that can be encoded.
    #[must_use]
    pub fn with_costs_scaled(mut self, factor: f64) -> Self {
        for op in &mut self.ops {
            if let Op::Charge { cycles } = op {
                cycles.0 = (f64::from(cycles.0) * factor).clamp(1.0, f64::from(i32::MAX)) as u32;
            }
        }
        self
    }

    /// The most cycles spent from one test of the budget to the next, `pure` functions of the firmware included.
    pub(crate) fn longest_step(&self, pure: &dyn Fn(GuestAddr) -> Option<Pure>) -> Cycles {
        let (mut charge, mut call) = (Cycles::default(), Cycles::default());
        for op in &self.ops {
            match op.kind() {
                OpKind::Charge => charge = charge.max(Cycles::new(meter::charged_cycles(op).into())),
                OpKind::Call => {
                    let cost = firmware_callee(op).and_then(pure).map_or(Cycles::default(), |pure| pure.cost);
                    call = call.max(cost);
                }
                OpKind::Structure
                | OpKind::Constant
                | OpKind::Move
                | OpKind::Address
                | OpKind::Arithmetic
                | OpKind::Negation
                | OpKind::Conversion
                | OpKind::Load(_)
                | OpKind::Store(_)
                | OpKind::Block
                | OpKind::Jump
                | OpKind::Branch
                | OpKind::Table
                | OpKind::Argument(_)
                | OpKind::Result(_)
                | OpKind::Return(_)
                | OpKind::Stop => {}
            }
        }
        charge + call
    }

    /// The constants of eight bytes.
    #[must_use]
    pub fn pool(&self) -> &[u64] {
        &self.pool
    }

    /// The signatures.
    #[must_use]
    pub fn signatures(&self) -> &[Signature] {
        &self.signatures
    }

    /// The functions in ascending order.
    #[must_use]
    pub fn functions(&self) -> &[Function] {
        &self.functions
    }

    /// Address of the word with the given index.
    #[must_use]
    pub fn address_of(&self, word: usize) -> CodeAddr {
        let address = self.base.wrapping_add((word * WORD) as u32);
        CodeAddr::new(address).expect("verification refuses a base that is not a multiple of 8")
    }

    /// Index of the word at `address`; `None` outside the text.
    #[must_use]
    pub fn word_at(&self, address: CodeAddr) -> Option<usize> {
        let word = address.get().checked_sub(self.base)? as usize / WORD;
        (word < self.ops.len()).then_some(word)
    }

    /// The function that starts at `address`; `main` for the start of the text, the entry point of an image.
    #[must_use]
    pub fn function_at(&self, address: GuestAddr) -> Option<FuncRef> {
        let address = self.main.filter(|_| address == self.start()).unwrap_or(address);
        let is_word = address.get().is_multiple_of(WORD as u32);
        let word = self.word_at(CodeAddr::new(address.get()).filter(|_| is_word)?)?;
        matches!(self.ops.get(word), Some(Op::Func { .. })).then_some(FuncRef(word as u32))
    }

    /// The signature that an instruction names.
    ///
    /// # Panics
    /// For a reference that is not of this program.
    #[must_use]
    pub fn signature(&self, signature: SigRef) -> &Signature {
        &self.signatures[usize::from(signature.0)]
    }

    /// The signature of a function.
    ///
    /// # Panics
    /// For a reference that is not of this program.
    #[must_use]
    pub fn signature_of(&self, function: FuncRef) -> &Signature {
        self.signature(self.head_of(function).0)
    }

    /// Signature, number of registers, and units of 8 bytes of the frame of a function.
    #[inline]
    pub(crate) fn head_of(&self, function: FuncRef) -> (SigRef, u16, u16) {
        let Op::Func { sig, regs, frame } = self.ops[function.0 as usize] else {
            unreachable!("a verified program refers to functions only")
        };
        (sig, regs.0, frame.0)
    }

    /// The place of a function among the functions; `None` for one that is not of this program.
    #[must_use]
    pub fn index_of(&self, function: FuncRef) -> Option<usize> {
        self.functions.binary_search_by_key(&function, |function| function.at).ok()
    }

    /// The function whose body contains the word with the given index.
    #[must_use]
    pub fn function_around(&self, word: usize) -> Option<&Function> {
        let next = self.functions.partition_point(|function| function.at.0 as usize <= word);
        let function = self.functions.get(next.checked_sub(1)?)?;
        (word < function.body.end).then_some(function)
    }
}

/// The address of the firmware function that an instruction calls.
fn firmware_callee(op: &Op) -> Option<GuestAddr> {
    if let Op::CallFw { addr, .. } = op { Some(GuestAddr::new(addr.0)) } else { None }
}
