//! Checks that a function is well formed; run after every stage in tests and debug builds.
//!
//! A finding is a defect of the compiler, never of the user's program.

use cranelift_entity::EntitySet;

use super::function::{Function, Signatures};
use super::inst::{Address, Base, BlockId, Callee, Class, InstKind, Operand, Terminator};

/// An error in a function, with its position.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{block}, instruction {index}: {message}")]
pub struct VerifyError {
    /// The block.
    pub block: BlockId,
    /// Index of the instruction; the number of instructions for the terminator.
    pub index: usize,
    /// The finding.
    pub message: String,
}

/// Checks classes, targets and ranges.
///
/// # Errors
/// The first finding.
pub fn verify(function: &Function, signatures: &Signatures) -> Result<(), VerifyError> {
    let mut placed = EntitySet::new();
    for &block in &function.layout {
        placed.insert(block);
    }
    let checker = Checker { function, signatures, placed };
    for &block in &function.layout {
        let data = &function.blocks[block];
        for (index, inst) in data.insts.iter().enumerate() {
            checker.inst(&inst.kind).map_err(|message| VerifyError { block, index, message })?;
        }
        let index = data.insts.len();
        checker.terminator(&data.terminator).map_err(|message| VerifyError { block, index, message })?;
    }
    Ok(())
}

struct Checker<'a> {
    function: &'a Function,
    signatures: &'a Signatures,
    /// The blocks of the layout.
    placed: EntitySet<BlockId>,
}

impl Checker<'_> {
    fn inst(&self, kind: &InstKind) -> Result<(), String> {
        let dst = kind.dst().map(|value| self.class(Operand::Value(value))).transpose()?;
        match *kind {
            InstKind::Copy { src, .. } => self.expect(src, dst),
            InstKind::Unary { op, src, .. } => {
                self.expect(src, dst)?;
                check(op.works_on(self.class(src)?), "no such operator on the class")
            }
            InstKind::Binary { op, a, b, .. } => {
                self.expect(a, dst)?;
                check(op.works_on(self.class(a)?), "no such operator on the class")?;
                self.expect(b, if op.is_shift() { Some(Class::I32) } else { dst })
            }
            InstKind::Compare { a, b, .. } => {
                check(dst == Some(Class::I32), "a comparison gives an i32")?;
                self.expect(b, Some(self.class(a)?))
            }
            InstKind::Convert { op, src, .. } => {
                check(dst == Some(op.to()), "result class of a conversion")?;
                self.expect(src, Some(op.from()))
            }
            InstKind::Load { width, address, .. } => {
                check(dst == Some(width.class()), "class of a load")?;
                self.address(address)
            }
            InstKind::Store { src, width, address } => {
                self.expect(src, Some(width.class()))?;
                self.address(address)
            }
            InstKind::FrameAddress { slot, .. } => {
                check(dst == Some(Class::I32), "an address is an i32")?;
                self.address(Address::new(Base::Slot(slot)))
            }
            InstKind::CopyMemory { to, from, .. } => {
                self.address(to)?;
                self.address(from)
            }
            InstKind::ClearMemory { to, .. } => self.address(to),
            InstKind::Cost { .. } => Ok(()),
            InstKind::Call { callee, arguments, signature, .. } => {
                if let Callee::Pointer(target) = callee {
                    self.expect(target, Some(Class::I32))?;
                }
                let signature = self.signatures.get(signature);
                check(dst.is_none() || dst == signature.result, "class of a call's result")?;
                let Some(arguments) = self.function.arguments.get(arguments.range()) else {
                    return Err("arguments out of range".to_owned());
                };
                check(arguments.len() == signature.params.len(), "number of arguments")?;
                arguments.iter().zip(&signature.params).try_for_each(|(a, c)| self.expect(*a, Some(*c)))
            }
        }
    }

    fn terminator(&self, terminator: &Terminator) -> Result<(), String> {
        check(terminator.targets().all(|to| self.placed.contains(to)), "no such block")?;
        match *terminator {
            Terminator::Branch { condition, .. } => self.expect(condition, Some(Class::I32)),
            Terminator::Table { index, .. } => self.expect(index, Some(Class::I32)),
            Terminator::Return(value) => {
                let expected = self.signatures.get(self.function.signature).result;
                let class = value.map(|value| self.class(value)).transpose()?;
                check(class == expected, "class of the result")
            }
            Terminator::Jump(_) | Terminator::Unreachable => Ok(()),
        }
    }

    fn address(&self, address: Address) -> Result<(), String> {
        match address.base {
            Base::Value(value) => self.expect(Operand::Value(value), Some(Class::I32)),
            Base::Slot(slot) => check(self.function.slots.is_valid(slot), "no such slot"),
            Base::Absolute | Base::Symbol(_) => Ok(()),
        }
    }

    fn class(&self, operand: Operand) -> Result<Class, String> {
        match operand {
            Operand::Constant(constant) => Ok(constant.class()),
            Operand::Value(value) => {
                self.function.values.get(value).copied().ok_or_else(|| format!("no such value {value}"))
            }
        }
    }

    fn expect(&self, operand: Operand, class: Option<Class>) -> Result<(), String> {
        let found = self.class(operand)?;
        match class {
            Some(class) if class == found => Ok(()),
            Some(class) => Err(format!("{operand:?} is {found}, {class} expected")),
            None => Err("nothing to write to".to_owned()),
        }
    }
}

fn check(holds: bool, message: &str) -> Result<(), String> {
    if holds { Ok(()) } else { Err(message.to_owned()) }
}
