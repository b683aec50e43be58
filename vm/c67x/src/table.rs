//! The instruction table: one row for each form; everything mechanical is expanded from it.
//!
//! `for_each_form!` passes all 302 rows to the caller's macro; the rows are in the files of this folder, one file for
//! each group of units. Here they become the [`Op`] enum and [`Op::row`].
//!
//! Rules of the table:
//! - A row is `/// formula`, then
//!   `Name = Mnemonic.Unit.form { field: Kind, … }, word value of mask, Timing, Isa;`.
//! - The fields are in the order of the assembler's text. Their positions in the word, and bits x, y and s, follow from
//!   their names and kinds ([`Field`], [`Kind`]).
//! - A word is of this form if `word & mask == value`. The mask excludes the bits creg, z and p, the side, and the
//!   fields; it includes the even bit of a pair, and x if there is no cross path.
//! - In formulas s1 and s2 are the values of `src1` and `src2`; R is the base register; sx
//!   and zx are sign and zero extension; sat32 and sat40 clamp.
//!
//! Source: the processor's published instruction set, checked against the vectors of
//! `tests/data` and an independent disassembler.

mod d;
mod l;
mod load;
mod m;
mod s;
mod store;

use crate::kind::{Field, Isa, Kind, Timing};
use crate::mnemonic::Mnemonic;
use crate::register::UnitKind;

/// Passes all rows of the instruction table to the macro `$m`.
#[macro_export]
macro_rules! for_each_form {
    ($m:ident) => {
        $crate::rows_of_l! { $m }
    };
}

/// A row of the table: the properties of a form.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Its name in the assembler.
    pub mnemonic: Mnemonic,
    /// The kind of unit that executes it; `None` for `NOP` and `IDLE`.
    pub unit: Option<UnitKind>,
    /// The kinds of its operands, src1_src2_dst, or the addressing mode of a load or store.
    pub form: &'static str,
    /// The bits of a word that determine the form.
    pub mask: u32,
    /// The value of these bits.
    pub value: u32,
    /// The operands in the order of the text.
    pub operands: &'static [(Field, Kind)],
    /// The timing: the stages in which it reads and writes.
    pub timing: Timing,
    /// The processor that introduced it.
    pub isa: Isa,
    /// The result, as a formula.
    pub meaning: &'static str,
}

macro_rules! define_ops {
    ($(
        $(#[doc = $doc:literal])*
        $name:ident = $mnemonic:ident.$unit:ident.$form:ident { $($field:ident: $kind:ident),* },
        word $value:literal of $mask:literal, $timing:ident, $isa:ident;
    )*) => {
        /// A form of an instruction: a row of the table.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u16)]
        pub enum Op {
            $($(#[doc = $doc])* $name,)*
        }

        impl Op {
            /// All forms.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// Its row of the table.
            #[must_use]
            pub const fn row(self) -> &'static Row {
                const ROWS: &[Row] = &[$(Row {
                    mnemonic: Mnemonic::$mnemonic,
                    unit: define_ops!(@unit $unit),
                    form: stringify!($form),
                    mask: $mask,
                    value: $value,
                    operands: &[$((define_ops!(@field $field), Kind::$kind)),*],
                    timing: Timing::$timing,
                    isa: Isa::$isa,
                    meaning: concat!($($doc),*).trim_ascii(),
                }),*];
                &ROWS[self as usize]
            }
        }
    };
    (@unit N) => { None };
    (@unit $unit:ident) => { Some(UnitKind::$unit) };
    (@field src1) => { Field::Src1 };
    (@field src2) => { Field::Src2 };
    (@field dst) => { Field::Dst };
    (@field src) => { Field::Src };
    (@field mem) => { Field::Mem };
    (@field csta) => { Field::Csta };
    (@field cstb) => { Field::Cstb };
    (@field cst) => { Field::Cst };
    (@field n) => { Field::N };
}
for_each_form!(define_ops);

impl Op {
    /// The form of a word, apart from the condition; `None` if there is none.
    #[must_use]
    pub fn of_word(word: u32) -> Option<Self> {
        Self::ALL.iter().copied().find(|op| word & op.row().mask == op.row().value)
    }

    /// `MNEMONIC.UNIT.form`, unique.
    #[must_use]
    pub fn id(self) -> String {
        let row = self.row();
        match row.unit {
            Some(unit) => format!("{}.{unit:?}.{}", row.mnemonic, row.form),
            None => format!("{}.-.{}", row.mnemonic, row.form),
        }
    }

    /// Reports whether published descriptions contradict each other about the order of the operands.
    ///
    /// `SUBSP .S` and `SUBDP .S` with opcodes 0x75 and 0x77: here src2 - src1, as the GNU
    /// tools read them; another table has src1 - src2 with the cross path on src1. No
    /// compiler emits them, and a generator must not.
    #[must_use]
    pub const fn is_disputed(self) -> bool {
        matches!(self, Self::SubspSRXrRRev | Self::SubdpSDXdDRev)
    }
}
