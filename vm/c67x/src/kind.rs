//! The kinds of operands, the positions of their fields in a word, and the timing of forms.

/// The name of an operand, which determines the position of its field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Field {
    /// First source, bits 17..13.
    Src1,
    /// Second source, bits 22..18.
    Src2,
    /// Destination, bits 27..23.
    Dst,
    /// The register that is stored, bits 27..23.
    Src,
    /// An address: base in 22..18, offset in 17..13; or a 15-bit offset in 22..8.
    Mem,
    /// First constant of a bit field, bits 17..13.
    Csta,
    /// Second constant of a bit field, bits 12..8.
    Cstb,
    /// A long constant, beginning with bit 7.
    Cst,
    /// Cycles, beginning with bit 13.
    N,
}

impl Field {
    /// The lowest bit of its field in a word; for [`Field::Mem`], of the offset's field.
    #[must_use]
    pub const fn lowest_bit(self) -> u32 {
        match self {
            Self::Src1 | Self::Csta | Self::N | Self::Mem => 13,
            Self::Src2 => 18,
            Self::Dst | Self::Src => 23,
            Self::Cstb => 8,
            Self::Cst => 7,
        }
    }

    /// Reports whether the instruction writes the operand.
    #[must_use]
    pub const fn is_written(self) -> bool {
        matches!(self, Self::Dst)
    }
}

/// The kind of an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A register of the unit's file.
    R,
    /// A register of the unit's file, of the other one if x is set.
    Xr,
    /// A 40-bit pair of the unit's file.
    L,
    /// A pair of the unit's file.
    D,
    /// A pair of the unit's file, of the other one if x is set.
    Xd,
    /// A pair as the only source: the odd register in src2, the even one in src1.
    Dodd,
    /// A signed constant of 5 bits.
    C5,
    /// An unsigned constant of 5 bits.
    U5,
    /// An unsigned constant of 4 bits.
    U4,
    /// A signed constant of 16 bits.
    C16,
    /// Bits 31..16 of a constant.
    H16,
    /// A signed displacement of 21 bits, in words from the fetch packet's address.
    Disp,
    /// Cycles of a `NOP`, 1..=9, less 1 in the word.
    Count,
    /// A register of file B.
    R2,
    /// A control register that is read.
    Cr,
    /// A control register that is written.
    Crw,
    /// The word `IRP`.
    Irp,
    /// The word `NRP`.
    Nrp,
    /// `*-R[u5]`
    NegC,
    /// `*+R[u5]`
    PosC,
    /// `*-R[r]`
    NegR,
    /// `*+R[r]`
    PosR,
    /// `*--R[u5]`
    PredecC,
    /// `*++R[u5]`
    PreincC,
    /// `*R--[u5]`
    PostdecC,
    /// `*R++[u5]`
    PostincC,
    /// `*--R[r]`
    PredecR,
    /// `*++R[r]`
    PreincR,
    /// `*R--[r]`
    PostdecR,
    /// `*R++[r]`
    PostincR,
    /// `*+B14[u15]`, `*+B15[u15]`, on .D2 alone.
    PosU15,
}

/// The addressing mode of a load or store.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Mode {
    /// True if the offset is subtracted.
    pub negative: bool,
    /// The update of the base register.
    pub update: Update,
    /// The kind of offset.
    pub offset: OffsetKind,
}

/// The update of the base register of a load or store.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Update {
    /// No update.
    None,
    /// The address is the updated base.
    Before,
    /// The address is the base before the update.
    After,
}

/// The kind of offset of a load or store.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum OffsetKind {
    /// A constant 0..=31.
    U5,
    /// A constant 0..=32767.
    U15,
    /// A signed register of the base's file.
    Reg,
}

impl Kind {
    /// The addressing mode of this kind; `None` for kinds that are not addresses.
    #[must_use]
    pub const fn mode(self) -> Option<Mode> {
        use OffsetKind::{Reg, U5, U15};
        use Update::{After, Before, None as Stays};
        const fn mode(negative: bool, update: Update, offset: OffsetKind) -> Option<Mode> {
            Some(Mode { negative, update, offset })
        }
        match self {
            Self::NegC => mode(true, Stays, U5),
            Self::PosC => mode(false, Stays, U5),
            Self::NegR => mode(true, Stays, Reg),
            Self::PosR => mode(false, Stays, Reg),
            Self::PredecC => mode(true, Before, U5),
            Self::PreincC => mode(false, Before, U5),
            Self::PostdecC => mode(true, After, U5),
            Self::PostincC => mode(false, After, U5),
            Self::PredecR => mode(true, Before, Reg),
            Self::PreincR => mode(false, Before, Reg),
            Self::PostdecR => mode(true, After, Reg),
            Self::PostincR => mode(false, After, Reg),
            Self::PosU15 => mode(false, Stays, U15),
            Self::R | Self::Xr | Self::L | Self::D | Self::Xd | Self::Dodd | Self::R2 => None,
            Self::C5 | Self::U5 | Self::U4 | Self::C16 | Self::H16 | Self::Disp | Self::Count => None,
            Self::Cr | Self::Crw | Self::Irp | Self::Nrp => None,
        }
    }

    /// The least and the greatest constant of this kind; `None` if it is not a constant.
    #[must_use]
    pub const fn range(self) -> Option<(i32, i32)> {
        match self {
            Self::C5 => Some((-16, 15)),
            Self::U5 => Some((0, 31)),
            Self::U4 => Some((0, 15)),
            Self::C16 => Some((-0x8000, 0x7FFF)),
            Self::H16 => Some((0, 0xFFFF)),
            Self::Disp => Some((-0x10_0000, 0xF_FFFF)),
            Self::Count => Some((1, 9)),
            Self::R | Self::Xr | Self::L | Self::D | Self::Xd | Self::Dodd | Self::R2 => None,
            Self::Cr | Self::Crw | Self::Irp | Self::Nrp => None,
            Self::NegC | Self::PosC | Self::PredecC | Self::PreincC | Self::PostdecC | Self::PostincC => None,
            Self::NegR | Self::PosR | Self::PredecR | Self::PreincR | Self::PostdecR | Self::PostincR => None,
            Self::PosU15 => None,
        }
    }

    /// Reports whether the operand may come from the other file over the cross path.
    #[must_use]
    pub const fn may_cross(self) -> bool {
        matches!(self, Self::Xr | Self::Xd)
    }
}

/// The processor that introduced a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Isa {
    /// The C67x.
    Base,
    /// The C67x+; the board's C6722 is one.
    Plus,
}

/// The times at which the forms of a row read their sources and write their results.
///
/// Stage E1 is the cycle of the issue. A result written in Ek is visible to packets that
/// issue k cycles later.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Timing {
    /// One cycle.
    Single,
    /// Products of 16 bits.
    Product,
    /// Instructions of four cycles: single-precision arithmetic and conversions to 32-bit results.
    Four,
    /// Integers to doubles.
    Widening,
    /// Sums of doubles.
    DoubleSum,
    /// Comparisons of doubles.
    DoubleCompare,
    /// Forms with one source and a double as result.
    DoubleMove,
    /// `MPYI`
    LongProduct,
    /// `MPYID`
    WideProduct,
    /// `MPYDP`
    DoubleProduct,
    /// `MPYSPDP`
    MixedProduct,
    /// `MPYSP2DP`
    SingleProduct,
    /// Loads: the base in E1, the result in E5.
    Load,
    /// Stores: memory in E3.
    Store,
    /// Branches: the target issues six cycles later.
    Branch,
    /// `NOP`, `IDLE`
    Nothing,
}

/// The stages of a [`Timing`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stages {
    /// Stage in which single registers and low halves of sources are first read.
    pub read_low: u8,
    /// Stage in which the high half of src1 is first read.
    pub read_high1: u8,
    /// Stage in which the high half of src2 is first read.
    pub read_high2: u8,
    /// Last stage in which a source is read.
    pub read_last: u8,
    /// Stage in which the result, or its low half, is written; 0 if there is none.
    pub write_low: u8,
    /// Stage in which the high half is written; 0 if there is no result.
    pub write_high: u8,
    /// The number of cycles from the issue in which the unit accepts no other instruction, including the issue cycle.
    pub unit: u8,
}

impl Timing {
    /// The stages.
    #[must_use]
    pub const fn stages(self) -> Stages {
        const fn stages(reads: [u8; 4], writes: [u8; 2], unit: u8) -> Stages {
            Stages {
                read_low: reads[0],
                read_high1: reads[1],
                read_high2: reads[2],
                read_last: reads[3],
                write_low: writes[0],
                write_high: writes[1],
                unit,
            }
        }
        match self {
            Self::Single => stages([1, 1, 1, 1], [1, 1], 1),
            Self::Product => stages([1, 1, 1, 1], [2, 2], 1),
            Self::Four => stages([1, 1, 1, 1], [4, 4], 1),
            Self::Widening => stages([1, 1, 1, 1], [4, 5], 1),
            Self::DoubleSum => stages([1, 2, 2, 2], [6, 7], 2),
            Self::DoubleCompare => stages([1, 2, 2, 2], [2, 2], 2),
            Self::DoubleMove => stages([1, 1, 1, 1], [1, 2], 1),
            Self::LongProduct => stages([1, 1, 1, 4], [9, 9], 4),
            Self::WideProduct => stages([1, 1, 1, 4], [9, 10], 4),
            Self::DoubleProduct => stages([1, 3, 2, 4], [9, 10], 4),
            Self::MixedProduct => stages([1, 1, 2, 3], [6, 7], 3),
            Self::SingleProduct => stages([1, 1, 1, 1], [4, 5], 2),
            Self::Load => stages([1, 1, 1, 1], [5, 5], 1),
            Self::Store | Self::Branch | Self::Nothing => stages([1, 1, 1, 1], [0, 0], 1),
        }
    }

    /// The number of delay slots: cycles from the issue until the last result may be read, minus 1.
    #[must_use]
    pub const fn delay_slots(self) -> u8 {
        match self {
            Self::Branch => 5,
            Self::Store | Self::Nothing => 0,
            Self::Single
            | Self::Product
            | Self::Four
            | Self::Widening
            | Self::DoubleSum
            | Self::DoubleCompare
            | Self::DoubleMove
            | Self::LongProduct
            | Self::WideProduct
            | Self::DoubleProduct
            | Self::MixedProduct
            | Self::SingleProduct
            | Self::Load => self.stages().write_high - 1,
        }
    }
}
