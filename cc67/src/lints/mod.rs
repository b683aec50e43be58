//! The warnings: one list, each with a code, a switch and a default.
//!
//! A row of `for_each_lint!` is a lint; its name is the `-W` switch. One that needs a search of
//! its own has a file in this folder: a pass over the finished typed tree, named in the row, or
//! a `finding` that analysis asks for where the syntax is at hand. What is one condition of a
//! rule that analysis checks anyway is reported there.

pub mod levels;

mod program;

mod call_back_wait;
mod firmware_name;
mod format;
mod idle_loop;
mod missing_return;
mod portability;
mod self_comparison;
mod uninitialized;

pub(crate) mod assignment_condition;
pub(crate) mod empty_body;
pub(crate) mod misleading_indentation;
pub(crate) mod unused_value;
pub(crate) mod user_data_alignment;
pub(crate) mod user_data_index;

use program::Program;

use crate::diag::Sink;
use crate::names::Names;
use crate::sema::FirmwareNames;
use crate::typed::Unit;

/// A search through a program.
type Pass = fn(&Program<'_>, &mut Sink);

/// Runs every pass over a program that was analysed.
pub fn check(unit: &Unit, names: &Names, firmware: &dyn FirmwareNames, sink: &mut Sink) {
    let program = Program { unit, names, firmware };
    PASSES.iter().for_each(|pass| pass(&program, sink));
}

/// Whether a lint speaks without being asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Default {
    /// Reported unless `-Wno-…`.
    On,
    /// Reported only with `-W…`.
    Off,
}

/// Hands every row of the lint table to the macro `$m`.
macro_rules! for_each_lint {
    ($m:ident) => {
        $m! {
            /// A function is used before anything declares it.
            ImplicitDeclaration = "implicit-declaration", On;
            /// An undeclared call is resolved by a later definition with integer types only.
            LateDefinition = "late-definition", Off;
            /// A name of the C library that firmware 4.34 lacks.
            Portability = "portability", Off, pass portability;
            /// Implicit `int` where programs seldom mean it.
            ImplicitInt = "implicit-int", On;
            /// An old-style parameter list.
            OldStyleDefinition = "old-style-definition", On;
            /// `main` has parameters, which the board does not pass.
            MainParameters = "main-parameters", On;
            /// A macro is defined again with another body.
            MacroRedefined = "macro-redefined", On;
            /// Text that the preprocessor accepts only because the vendor's does.
            LaxText = "lax-text", On;
            /// A function, local or enumerator is declared twice.
            Redeclared = "redeclared", On, pass firmware_name;
            /// A prototype differs from the definition.
            PrototypeMismatch = "prototype-mismatch", On;
            /// More arguments than the definition takes.
            ExtraArguments = "extra-arguments", On;
            /// An integer and a pointer are mixed without a cast.
            IntPointer = "int-pointer", On;
            /// Pointers to types of different size or kind are mixed without a cast.
            PointerMismatch = "pointer-mismatch", On;
            /// An assignment is used as a condition.
            AssignmentCondition = "assignment-condition", On;
            /// A statement computes a value and drops it.
            UnusedValue = "unused-value", On;
            /// `if (x) ;`
            EmptyBody = "empty-body", On;
            /// The value of a void function is used.
            VoidValue = "void-value", On;
            /// A function that returns a value may end without one.
            MissingReturn = "missing-return", Off, pass missing_return;
            /// An integer constant with a suffix `f`.
            IntegerFloatSuffix = "integer-float-suffix", On;
            /// A constant shift count outside 0..31.
            ShiftCount = "shift-count", On;
            /// A format conversion does not fit its argument.
            Format = "format", On, pass format;
            /// A local is read before anything is stored in it.
            Uninitialized = "uninitialized", On, pass uninitialized;
            /// A string is longer than the array it initialises.
            LongString = "long-string", On;
            /// A write to a `const` object.
            ConstWrite = "const-write", On;
            /// `persist.UserData` is indexed outside 0..199.
            UserDataIndex = "user-data-index", On;
            /// A `double` at an odd index of `persist.UserData`.
            UserDataAlignment = "user-data-alignment", On;
            /// A frame or call chain larger than the board's small stack.
            StackSize = "stack-size", On;
            /// A floating-point value compared with itself.
            SelfComparison = "self-comparison", On, pass self_comparison;
            /// An endless loop that neither waits nor has an effect.
            IdleLoop = "idle-loop", On, pass idle_loop;
            /// A statement is indented as if the condition above it governed it.
            MisleadingIndentation = "misleading-indentation", On;
            /// A function that may wait is called in the call-back of the servo interrupt.
            CallBackWait = "call-back-wait", On, pass call_back_wait;
            /// Something portable C does not allow and the vendor's compiler accepts.
            Extension = "extension", On;
        }
    };
}

macro_rules! define_lints {
    ($($(#[$doc:meta])* $variant:ident = $name:literal, $default:ident $(, pass $pass:ident)?;)*) => {
        /// A warning that a switch controls.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Lint {
            $($(#[$doc])* $variant,)*
        }

        /// The searches, in the order of the table.
        const PASSES: &[Pass] = &[$($($pass::check,)?)*];

        impl Lint {
            /// Every lint in the order of the table.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// The name of its switch, without `-W`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// Whether it speaks without being asked.
            #[must_use]
            pub const fn default(self) -> Default {
                match self {
                    $(Self::$variant => Default::$default,)*
                }
            }
        }
    };
}
for_each_lint!(define_lints);
