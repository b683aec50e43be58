//! Checks of one function: operands, calls, branches, charges.

use super::{VerifyError, VerifyErrorKind, signature};
use crate::firmware::Signature;
use crate::for_each_op;
use crate::kind::{Name, OpKind};
use crate::meter;
use crate::op::Op;
use crate::operand::{
    Addr, Bits32, Class, Classes, Count, Count32, FuncRef, Imm, Imm16, Label, Off, OperandType, Pool, RegF32,
    RegF64, RegI32, RegI64, SigRef,
};
use crate::program::{Function, Program};

/// Checks the body of `function`.
pub(super) fn check_body(program: &Program, function: &Function) -> Result<(), VerifyError> {
    let mut body = Body { program, function, inner: vec![false; function.body.len()] };
    body.check_groups()?;
    for at in function.body.clone() {
        let op = body.op(at);
        check_operands(op, &body)
            .and_then(|()| body.check_placement(op))
            .map_err(|kind| VerifyError { at, kind })?;
    }
    body.check_end()?;
    body.check_charges()
}

struct Body<'a> {
    program: &'a Program,
    function: &'a Function,
    /// The words that no branch may enter, by offset in the body.
    inner: Vec<bool>,
}

impl Body<'_> {
    /// The word `at`; after the body, a word that acts like `unreachable`.
    fn op(&self, at: usize) -> Op {
        let op = if self.function.body.contains(&at) { self.program.ops.get(at) } else { None };
        op.copied().unwrap_or(Op::Unreachable {})
    }

    /// Checks that the words of arguments, calls, results and tables are grouped correctly.
    fn check_groups(&mut self) -> Result<(), VerifyError> {
        let mut at = self.function.body.start;
        while at < self.function.body.end {
            let op = self.op(at);
            let length = match op.kind() {
                OpKind::Table => {
                    self.table(at, op.operand(Name::Count).map_or(0, |Count(n)| usize::from(n) + 1))
                }
                OpKind::Argument(_) | OpKind::Call => self.call(at),
                OpKind::Result(_) => Err(VerifyError { at, kind: VerifyErrorKind::Result }),
                OpKind::Structure
                | OpKind::Charge
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
                | OpKind::Return(_)
                | OpKind::Stop => Ok(1),
            }?;
            for inner in at + 1..at + length {
                self.mark_inner(inner);
            }
            at += length;
        }
        Ok(())
    }

    fn mark_inner(&mut self, at: usize) {
        let offset = at.checked_sub(self.function.body.start);
        if let Some(inner) = offset.and_then(|offset| self.inner.get_mut(offset)) {
            *inner = true;
        }
    }

    /// The length of the table at `at` with its `count` branches.
    fn table(&self, at: usize, count: usize) -> Result<usize, VerifyError> {
        let complete = (at + 1..=at + count).all(|at| self.op(at).kind() == OpKind::Jump);
        if complete { Ok(1 + count) } else { Err(VerifyError { at, kind: VerifyErrorKind::Table(count) }) }
    }

    /// The length of the call whose first word, an argument or the call itself, is at `at`.
    fn call(&self, at: usize) -> Result<usize, VerifyError> {
        let mut classes = Vec::new();
        let mut next = at;
        while let Some((class, index)) = argument(&self.op(next)) {
            if usize::from(index.0) != classes.len() {
                return Err(VerifyError { at: next, kind: VerifyErrorKind::Arguments });
            }
            classes.push(class);
            next += 1;
        }
        let fail = |kind| VerifyError { at: next, kind };
        let callee = self.callee(&self.op(next)).map_err(fail)?;
        if callee.params != classes {
            return Err(fail(VerifyErrorKind::ArgumentClasses));
        }
        next += 1;
        if let Some(class) = result(&self.op(next)) {
            if callee.result != Some(class) {
                return Err(VerifyError { at: next, kind: VerifyErrorKind::Result });
            }
            next += 1;
        }
        Ok(next - at)
    }

    /// The signature that the call `op` states.
    fn callee(&self, op: &Op) -> Result<&Signature, VerifyErrorKind> {
        if op.kind() != OpKind::Call {
            return Err(VerifyErrorKind::Arguments);
        }
        let stated = op.operand(Name::Func).map(|func| self.function_signature(func)).transpose()?;
        let sig = stated.or_else(|| op.operand(Name::Sig)).ok_or(VerifyErrorKind::Arguments)?;
        signature(self.program, sig)
    }

    fn function_signature(&self, func: FuncRef) -> Result<SigRef, VerifyErrorKind> {
        let found = self.program.functions.binary_search_by_key(&func, |function| function.at);
        let function = found.ok().and_then(|index| self.program.functions.get(index));
        function.map(|function| function.signature).ok_or(VerifyErrorKind::NoFunction(func.0))
    }

    /// Checks the requirements of an instruction that do not concern its operands.
    fn check_placement(&self, op: Op) -> Result<(), VerifyErrorKind> {
        let expected = signature(self.program, self.function.signature)?.result;
        let check_return = |class: Option<Class>| {
            if class == expected { Ok(()) } else { Err(VerifyErrorKind::ReturnClass) }
        };
        match op.kind() {
            OpKind::Structure => Err(VerifyErrorKind::Misplaced(op.name())),
            OpKind::Return(class) => check_return(class),
            OpKind::Charge
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
            | OpKind::Call
            | OpKind::Result(_)
            | OpKind::Stop => Ok(()),
        }
    }

    /// Checks that the last word does not continue after the function.
    fn check_end(&self) -> Result<(), VerifyError> {
        let at = self.function.body.end.saturating_sub(1);
        if self.op(at).kind().ends_path() {
            Ok(())
        } else {
            Err(VerifyError { at, kind: VerifyErrorKind::FallsOff })
        }
    }

    /// Checks that every path through the function and each of its loops has a charge.
    fn check_charges(&self) -> Result<(), VerifyError> {
        let found = meter::find_uncharged(&self.program.ops, self.function.body.clone());
        found.map_or(Ok(()), |at| Err(VerifyError { at, kind: VerifyErrorKind::Uncharged }))
    }
}

/// Class and index of an argument.
fn argument(op: &Op) -> Option<(Class, Count)> {
    let OpKind::Argument(class) = op.kind() else { return None };
    Some((class, op.operand(Name::Index)?))
}

/// Returns the class of the call result that the instruction takes.
const fn result(op: &Op) -> Option<Class> {
    if let OpKind::Result(class) = op.kind() { Some(class) } else { None }
}

/// An operand that is checked by its type.
trait CheckOperand: OperandType {
    /// Checks that the operand refers to something that exists.
    fn check(self, body: &Body<'_>) -> Result<(), VerifyErrorKind>;
}

macro_rules! any_value {
    ($($operand:ident),*) => {$(
        impl CheckOperand for $operand {
            fn check(self, _: &Body<'_>) -> Result<(), VerifyErrorKind> {
                Ok(())
            }
        }
    )*};
}
any_value!(Addr, Bits32, Classes, Count, Count32, Imm, Imm16, Off);

macro_rules! registers {
    ($($register:ident: $class:ident),*) => {$(
        impl CheckOperand for $register {
            fn check(self, body: &Body<'_>) -> Result<(), VerifyErrorKind> {
                match body.function.classes.get(self.index()) {
                    None => Err(VerifyErrorKind::NoRegister(self.0)),
                    Some(Class::$class) => Ok(()),
                    Some(other) => Err(VerifyErrorKind::RegisterClass(self.0, *other, Class::$class)),
                }
            }
        }
    )*};
}
registers!(RegI32: I32, RegI64: I64, RegF32: F32, RegF64: F64);

impl CheckOperand for Pool {
    fn check(self, body: &Body<'_>) -> Result<(), VerifyErrorKind> {
        let size = body.program.pool.len();
        if usize::try_from(self.0).is_ok_and(|index| index < size) {
            Ok(())
        } else {
            Err(VerifyErrorKind::NoConstant(self.0))
        }
    }
}

impl CheckOperand for SigRef {
    fn check(self, body: &Body<'_>) -> Result<(), VerifyErrorKind> {
        signature(body.program, self).map(|_| ())
    }
}

impl CheckOperand for FuncRef {
    fn check(self, body: &Body<'_>) -> Result<(), VerifyErrorKind> {
        body.function_signature(self).map(|_| ())
    }
}

impl CheckOperand for Label {
    fn check(self, body: &Body<'_>) -> Result<(), VerifyErrorKind> {
        let target = usize::try_from(self.0).unwrap_or(usize::MAX);
        let offset = target.checked_sub(body.function.body.start);
        match offset.and_then(|offset| body.inner.get(offset)) {
            Some(false) => Ok(()),
            _ => Err(VerifyErrorKind::BadLabel(self.0)),
        }
    }
}

macro_rules! define_check {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        /// Checks every operand of `op`.
        fn check_operands(op: Op, body: &Body<'_>) -> Result<(), VerifyErrorKind> {
            match op {
                $(Op::$variant { $($field),* } => {
                    $($field.check(body)?;)*
                    Ok(())
                })*
            }
        }
    };
}
for_each_op!(define_check);
