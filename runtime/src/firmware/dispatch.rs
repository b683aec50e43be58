//! Dispatches from a firmware address to its Rust function, expanded from the table.
//!
//! A firmware function takes the parts, the caller and its C arguments, and returns its natural type: nothing, a
//! number, a `Result` if it may trap, an `Outcome` if it may wait. A row of the table without a function, or a function
//! whose arguments differ in number, is a compile error that names it.

use kmotiondef::GuestAddr;
use vm::call::CallArguments;
use vm::firmware::{Caller, Outcome, Signature, Value};
use vm::operand::Class;
use vm::slot::Slot;
use vm::trap::TrapKind;

use super::parts::Parts;
use crate::firmware::{
    console, coord, gather, io, konnect, math, motion, persist, serial, snapamp, spindle, stdlib, string,
    sync, thread, time,
};

/// The outcome of a call.
pub(crate) type Answer = Result<Outcome<Value>, TrapKind>;

/// One firmware function under one signature.
pub(crate) type Handler = fn(&mut Parts, &mut Caller<'_>) -> Answer;

/// The address of the values after `...`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Varargs(pub(crate) GuestAddr);

/// A C argument as a Rust value.
trait FromGuest {
    /// The class of register that carries it.
    const CLASS: Class;
    /// The argument at a position.
    fn from_guest(arguments: CallArguments<'_>, position: usize) -> Self;
}

macro_rules! slots {
    ($($ty:ty),*) => {$(
        impl FromGuest for $ty {
            const CLASS: Class = <$ty as Slot>::CLASS;

            fn from_guest(arguments: CallArguments<'_>, position: usize) -> Self {
                arguments.get(position)
            }
        }
    )*};
}
slots!(i32, u32, f32, f64, GuestAddr);

impl FromGuest for u8 {
    const CLASS: Class = Class::I32;

    fn from_guest(arguments: CallArguments<'_>, position: usize) -> Self {
        arguments.get::<u32>(position) as Self
    }
}

impl FromGuest for Varargs {
    const CLASS: Class = Class::I32;

    fn from_guest(arguments: CallArguments<'_>, position: usize) -> Self {
        Self(arguments.get(position))
    }
}

/// A result of a firmware function.
trait IntoOutcome {
    /// The class of register that carries it; `None` for no result.
    const CLASS: Option<Class>;
    /// The result as the machine takes it.
    fn into_outcome(self) -> Answer;
}

macro_rules! values {
    ($($ty:ty as $class:ident, $value:expr;)*) => {$(
        impl IntoOutcome for $ty {
            const CLASS: Option<Class> = Some(Class::$class);

            fn into_outcome(self) -> Answer {
                Ok(Outcome::Done($value(self)))
            }
        }
    )*};
}
values! {
    i32 as I32, Value::I32;
    u32 as I32, |value: u32| Value::I32(value as i32);
    GuestAddr as I32, |value: GuestAddr| Value::I32(value.get() as i32);
    f32 as F32, Value::F32;
    f64 as F64, Value::F64;
}

impl IntoOutcome for () {
    const CLASS: Option<Class> = None;

    fn into_outcome(self) -> Answer {
        Ok(Outcome::Done(Value::Unit))
    }
}

impl<T: IntoOutcome> IntoOutcome for Outcome<T> {
    const CLASS: Option<Class> = T::CLASS;

    fn into_outcome(self) -> Answer {
        match self {
            Self::Done(value) => value.into_outcome(),
            Self::Wait(wake) => Ok(Outcome::Wait(wake)),
            Self::End => Ok(Outcome::End),
        }
    }
}

impl<T: IntoOutcome> IntoOutcome for Result<T, TrapKind> {
    const CLASS: Option<Class> = T::CLASS;

    fn into_outcome(self) -> Answer {
        self.and_then(T::into_outcome)
    }
}

/// A Rust function that takes `Parameters` after parts and caller.
pub(super) trait FirmwareFunction<Parameters> {
    /// The classes of its arguments.
    const PARAMETERS: &'static [Class];
    /// The class of its result.
    const RESULT: Option<Class>;
    /// Calls it with the caller's arguments.
    fn invoke(self, parts: &mut Parts, caller: &mut Caller<'_>) -> Answer;
}

impl<F, R> FirmwareFunction<()> for F
where
    F: Fn(&mut Parts, &mut Caller<'_>) -> R,
    R: IntoOutcome,
{
    const PARAMETERS: &'static [Class] = &[];
    const RESULT: Option<Class> = R::CLASS;

    fn invoke(self, parts: &mut Parts, caller: &mut Caller<'_>) -> Answer {
        self(parts, caller).into_outcome()
    }
}

macro_rules! functions {
    ($(($($parameter:ident)*);)*) => {$(
        impl<F, R, $($parameter),*> FirmwareFunction<($($parameter,)*)> for F
        where
            F: Fn(&mut Parts, &mut Caller<'_>, $($parameter),*) -> R,
            R: IntoOutcome,
            $($parameter: FromGuest,)*
        {
            const PARAMETERS: &'static [Class] = &[$($parameter::CLASS),*];
            const RESULT: Option<Class> = R::CLASS;

            fn invoke(self, parts: &mut Parts, caller: &mut Caller<'_>) -> Answer {
                let (arguments, mut positions) = (caller.arguments, 0..);
                // The machine has checked their number against the signature.
                self(parts, caller, $($parameter::from_guest(arguments, positions.next().unwrap_or(0))),*)
                    .into_outcome()
            }
        }
    )*};
}

functions! {
    (A);
    (A B);
    (A B C);
    (A B C D);
    (A B C D E);
    (A B C D E G);
    (A B C D E G H);
    (A B C D E G H I);
    (A B C D E G H I J);
}

macro_rules! handlers {
    ($(
        $(#[doc = $doc:literal])+
        $group:ident::$function:ident = $name:ident $params:tt $(-> $result:ty)?,
            at $address:literal, cost $cost:literal, $origin:ident
            $(, $attribute:ident $(($($value:tt)*))?)*;
    )*) => {
        /// One handler a function, by its number in the table.
        pub(crate) const HANDLERS: &[Handler] =
            &[$(|parts, caller| FirmwareFunction::invoke($group::$function, parts, caller)),*];

        /// The signatures of the functions, by number.
        pub(crate) fn signatures() -> Vec<Signature> {
            vec![$(signature_of($group::$function)),*]
        }
    };
}
kmotiondef::for_each_firmware_fn!(handlers);

/// Calls a Rust function with the caller's arguments.
pub(super) fn handler_of<P, F: FirmwareFunction<P>>(
    function: F,
    parts: &mut Parts,
    caller: &mut Caller<'_>,
) -> Answer {
    function.invoke(parts, caller)
}

/// The signature of a Rust function as classes.
pub(super) fn signature_of<P, F: FirmwareFunction<P>>(_: F) -> Signature {
    Signature { params: F::PARAMETERS.to_vec(), result: F::RESULT }
}

#[cfg(test)]
mod tests {
    use kmotiondef::ValueClass;
    use kmotiondef::firmware::FIRMWARE_FUNCTIONS;

    use super::*;

    fn class(class: ValueClass) -> Class {
        match class {
            ValueClass::I32 => Class::I32,
            ValueClass::I64 => Class::I64,
            ValueClass::F32 => Class::F32,
            ValueClass::F64 => Class::F64,
        }
    }

    #[test]
    fn every_function_has_the_signature_of_its_row() {
        assert_eq!(FIRMWARE_FUNCTIONS.len(), HANDLERS.len());
        for (row, rust) in FIRMWARE_FUNCTIONS.iter().zip(signatures()) {
            let mut params: Vec<Class> = row.param_classes().map(class).collect();
            params.extend(row.is_variadic.then_some(Class::I32));
            assert_eq!(rust.params, params, "{}", row.prototype());
            assert_eq!(rust.result, row.result.class().map(class), "{}", row.prototype());
        }
    }

    #[test]
    fn every_call_costs_what_was_measured() {
        let measured = crate::text::vectors::rows("costs.jsonl");
        let mut compared = 0;
        for row in FIRMWARE_FUNCTIONS {
            let of_row = |line: &&serde_json::Value| line["kind"] == "function" && line["name"] == row.name;
            let cost = measured.iter().find(of_row).and_then(|line| line["table_cost"].as_i64());
            if let Some(cost) = cost {
                assert_eq!(row.cost.get(), cost, "{}", row.name);
                compared += 1;
            }
        }
        assert!(compared > 150, "{compared}");
    }
}
