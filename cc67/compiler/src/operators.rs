//! The binary operators of C, and their meanings.
//!
//! An operator is a row of `for_each_binary_operator!`: its spelling and its precedence. Its computation is a row of
//! `for_each_binary_op!`. Preprocessor, parser, analysis and lowering expand both, so that an operator is known to all
//! of them, or to none.

use std::cmp::Ordering;

use vm::arith;

/// Passes every binary operator of C to the macro `$m`: its text and token, its precedence (larger binds tighter), the
/// token of its assignment if it has one, and its meaning.
macro_rules! for_each_binary_operator {
    ($m:ident) => {
        $m! {
            Multiply "*" = Star 12, StarAssign => Arithmetic(BinaryOp::Multiply);
            Divide "/" = Slash 12, SlashAssign => Arithmetic(BinaryOp::Divide);
            Remainder "%" = Percent 12, PercentAssign => Bitwise(BinaryOp::Remainder);
            Add "+" = Plus 11, PlusAssign => Arithmetic(BinaryOp::Add);
            Subtract "-" = Minus 11, MinusAssign => Arithmetic(BinaryOp::Subtract);
            ShiftLeft "<<" = ShiftLeft 10, ShiftLeftAssign => Shift(BinaryOp::ShiftLeft);
            ShiftRight ">>" = ShiftRight 10, ShiftRightAssign => Shift(BinaryOp::ShiftRight);
            Less "<" = Less 9 => Compare(CompareOp::Less);
            Greater ">" = Greater 9 => Compare(CompareOp::Greater);
            LessEqual "<=" = LessEqual 9 => Compare(CompareOp::LessEqual);
            GreaterEqual ">=" = GreaterEqual 9 => Compare(CompareOp::GreaterEqual);
            Equal "==" = Equal 8 => Compare(CompareOp::Equal);
            NotEqual "!=" = NotEqual 8 => Compare(CompareOp::NotEqual);
            And "&" = And 7, AndAssign => Bitwise(BinaryOp::And);
            Xor "^" = Xor 6, XorAssign => Bitwise(BinaryOp::Xor);
            Or "|" = Or 5, OrAssign => Bitwise(BinaryOp::Or);
            LogicalAnd "&&" = AndAnd 4 => Logical(false);
            LogicalOr "||" = OrOr 3 => Logical(true);
        }
    };
}
pub(crate) use for_each_binary_operator;

macro_rules! define_binary_operators {
    ($(
        $operator:ident $text:literal = $token:ident $binding:literal $(, $assignment:ident)? => $meaning:ident($of:expr);
    )*) => {
        /// Binary operators.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum BinaryOperator {
            $(
                #[doc = concat!("`", $text, "`")]
                $operator,
            )*
        }

        impl BinaryOperator {
            /// The operator as written in the source.
            #[must_use]
            pub const fn spelling(self) -> &'static str {
                match self {
                    $(Self::$operator => $text,)*
                }
            }

            /// Its precedence; larger binds tighter.
            #[must_use]
            pub(crate) const fn binding(self) -> u8 {
                match self {
                    $(Self::$operator => $binding,)*
                }
            }

            /// Its meaning.
            #[must_use]
            pub(crate) const fn meaning(self) -> OperatorMeaning {
                match self {
                    $(Self::$operator => OperatorMeaning::$meaning($of),)*
                }
            }
        }
    };
}

for_each_binary_operator!(define_binary_operators);

/// The meaning of a binary operator, by the operands it accepts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum OperatorMeaning {
    /// Arithmetic, and pointer steps with `+` and `-`.
    Arithmetic(BinaryOp),
    /// Integers only.
    Bitwise(BinaryOp),
    /// Integers only, each promoted separately.
    Shift(BinaryOp),
    /// A comparison.
    Compare(CompareOp),
    /// `&&` or `||`, with the value of the left side that decides the result.
    Logical(bool),
}

/// A computation of two integers.
pub(crate) type IntegerOperation = fn(i64, i64) -> Option<i64>;

/// Passes every operation to the macro `$m`: its printed form, the machine's operator, and the computations in `#if`,
/// also for unsigned operands if they differ, and in index checks, which have no width.
macro_rules! for_each_binary_op {
    ($m:ident) => {
        $m! {
            /// `a + b`
            Add "+" = Add |a, b| Some(a.wrapping_add(b)), exact i64::checked_add;
            /// `a - b`
            Subtract "-" = Subtract |a, b| Some(a.wrapping_sub(b)), exact i64::checked_sub;
            /// `a * b`
            Multiply "*" = Multiply |a, b| Some(a.wrapping_mul(b)), exact i64::checked_mul;
            /// `a / b`
            Divide "/" = Divide arith::div_i64_s, unsigned DivideUnsigned arith::div_i64_u;
            /// `a % b`
            Remainder "%" = Remainder arith::rem_i64_s, unsigned RemainderUnsigned arith::rem_i64_u;
            /// `a & b`
            And "&" = And |a, b| Some(a & b);
            /// `a | b`
            Or "|" = Or |a, b| Some(a | b);
            /// `a ^ b`
            Xor "^" = Xor |a, b| Some(a ^ b);
            /// `a << b`
            ShiftLeft "<<" = ShiftLeft |a, b| Some(arith::shl_i64(a, b as i32));
            /// `a >> b`
            ShiftRight ">>" = ShiftRight |a, b| Some(arith::shr_i64_s(a, b as i32)),
                unsigned ShiftRightUnsigned |a, b| Some(arith::shr_i64_u(a, b as i32));
        }
    };
}
pub(crate) use for_each_binary_op;

macro_rules! define_binary_ops {
    (@exact) => { None };
    (@exact $exact:expr) => { Some($exact) };
    ($(
        #[doc = $doc:literal]
        $op:ident $text:literal = $machine:ident $signed:expr
            $(, unsigned $machine_unsigned:ident $unsigned:expr)? $(, exact $exact:expr)?;
    )*) => {
        /// Operations on two values; signedness follows from their type. On pointers only `Add` and `Subtract` of an
        /// `int` byte count occur.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum BinaryOp {
            $(
                #[doc = $doc]
                $op,
            )*
        }

        impl BinaryOp {
            /// As the typed tree prints it.
            #[must_use]
            pub(crate) const fn spelling(self) -> &'static str {
                match self {
                    $(Self::$op => $text,)*
                }
            }

            /// The computation on integers of 64 bits; `None` for a division by zero.
            #[must_use]
            pub(crate) const fn in_64_bits(self, is_unsigned: bool) -> IntegerOperation {
                match self {
                    $($(Self::$op if is_unsigned => $unsigned,)?
                    Self::$op => $signed,)*
                }
            }

            /// Computes the operator on integers without overflow; `None` for operators not supported by index checks,
            /// and for results beyond 64 bits.
            #[must_use]
            pub(crate) fn exactly(self, a: i64, b: i64) -> Option<i64> {
                let exact: Option<IntegerOperation> = match self {
                    $(Self::$op => define_binary_ops!(@exact $($exact)?),)*
                };
                exact.and_then(|exact| exact(a, b))
            }
        }
    };
}

for_each_binary_op!(define_binary_ops);

macro_rules! define_compare_ops {
    ($(#[doc = $doc:literal] $op:ident $text:literal = $holds:expr;)*) => {
        /// Comparisons; signedness follows from the operands' type.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum CompareOp {
            $(
                #[doc = $doc]
                $op,
            )*
        }

        impl CompareOp {
            /// As the typed tree prints it.
            #[must_use]
            pub(crate) const fn spelling(self) -> &'static str {
                match self {
                    $(Self::$op => $text,)*
                }
            }

            /// Reports whether it holds for values in this order; `None` if one of them is not a number.
            #[must_use]
            pub(crate) fn holds(self, order: Option<Ordering>) -> bool {
                match self {
                    $(Self::$op => $holds(order),)*
                }
            }
        }
    };
}

define_compare_ops! {
    /// `a == b`
    Equal "==" = |order: Option<Ordering>| order.is_some_and(Ordering::is_eq);
    /// `a != b`
    NotEqual "!=" = |order: Option<Ordering>| order.is_none_or(Ordering::is_ne);
    /// `a < b`
    Less "<" = |order: Option<Ordering>| order.is_some_and(Ordering::is_lt);
    /// `a <= b`
    LessEqual "<=" = |order: Option<Ordering>| order.is_some_and(Ordering::is_le);
    /// `a > b`
    Greater ">" = |order: Option<Ordering>| order.is_some_and(Ordering::is_gt);
    /// `a >= b`
    GreaterEqual ">=" = |order: Option<Ordering>| order.is_some_and(Ordering::is_ge);
}
