//! Registers, pairs, control registers, predicates and units of the processor.
//!
//! The register file has two sides of 32 registers. A register is a number 0..=63, the A side first, as in the vectors;
//! a pair is identified by its even register, which contains the low word.

use std::fmt;

/// One of the two halves of the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// Registers A0 to A31, units .L1 .S1 .M1 .D1.
    A,
    /// Registers B0 to B31, units .L2 .S2 .M2 .D2.
    B,
}

impl Side {
    /// Side A for 0, side B for 1, as in bits s and y.
    #[must_use]
    #[inline]
    pub const fn from_bit(bit: u32) -> Self {
        if bit & 1 == 0 { Self::A } else { Self::B }
    }

    /// 0 for side A, 1 for side B.
    #[must_use]
    #[inline]
    pub const fn bit(self) -> u32 {
        match self {
            Self::A => 0,
            Self::B => 1,
        }
    }

    /// The opposite side.
    #[must_use]
    #[inline]
    pub const fn other(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }

    /// 1 or 2, as in the names of units.
    #[must_use]
    #[inline]
    pub const fn number(self) -> u8 {
        match self {
            Self::A => 1,
            Self::B => 2,
        }
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::A => "A",
            Self::B => "B",
        })
    }
}

/// A register: A0..=A31 are 0..=31, B0..=B31 are 32..=63.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Reg(u8);

impl Reg {
    /// The number of registers.
    pub const COUNT: usize = 64;

    /// Register `number` of `side`; only the low five bits of the number count.
    #[must_use]
    #[inline]
    pub const fn new(side: Side, number: u8) -> Self {
        Self((number & 31) | ((side.bit() as u8) << 5))
    }

    /// Register `number` (0..=31) of side A.
    #[must_use]
    #[inline]
    pub const fn a(number: u8) -> Self {
        Self::new(Side::A, number)
    }

    /// Register `number` (0..=31) of side B.
    #[must_use]
    #[inline]
    pub const fn b(number: u8) -> Self {
        Self::new(Side::B, number)
    }

    /// The register with this index; `None` for 64 and above.
    #[must_use]
    #[inline]
    pub const fn from_index(index: usize) -> Option<Self> {
        if index < Self::COUNT { Some(Self(index as u8)) } else { None }
    }

    /// 0..=63, side A first.
    #[must_use]
    #[inline]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The side of its file.
    #[must_use]
    #[inline]
    pub const fn side(self) -> Side {
        Side::from_bit((self.0 >> 5) as u32)
    }

    /// 0..=31 inside its file.
    #[must_use]
    #[inline]
    pub const fn number(self) -> u8 {
        self.0 & 31
    }

    /// The pair that contains it.
    #[must_use]
    #[inline]
    pub const fn pair(self) -> Pair {
        Pair(Self(self.0 & !1))
    }
}

impl fmt::Display for Reg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.side(), self.number())
    }
}

impl fmt::Debug for Reg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Two registers, odd:even: a double, a 40-bit long, or the two words of an `LDDW`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair(Reg);

impl Pair {
    /// The pair with this even register; `None` for an odd one.
    #[must_use]
    #[inline]
    pub const fn new(low: Reg) -> Option<Self> {
        if low.0 & 1 == 0 { Some(Self(low)) } else { None }
    }

    /// The even register: bits 31..0.
    #[must_use]
    #[inline]
    pub const fn low(self) -> Reg {
        self.0
    }

    /// The odd register: bits 63..32, or 39..32 of a long.
    #[must_use]
    #[inline]
    pub const fn high(self) -> Reg {
        Reg(self.0.0 | 1)
    }

    /// The side of its file.
    #[must_use]
    #[inline]
    pub const fn side(self) -> Side {
        self.0.side()
    }
}

impl fmt::Display for Pair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.high(), self.low())
    }
}

impl fmt::Debug for Pair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// The condition of an instruction: bits creg and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pred {
    /// Executes always.
    Always,
    /// Executes if the register is not 0.
    If(PredReg),
    /// Executes if the register is 0.
    Unless(PredReg),
}

/// A register that can be a condition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PredReg {
    /// B0, creg 1.
    B0,
    /// B1, creg 2.
    B1,
    /// B2, creg 3.
    B2,
    /// A1, creg 4.
    A1,
    /// A2, creg 5.
    A2,
    /// A0, creg 6.
    A0,
}

impl PredReg {
    /// All condition registers in the order of the field creg, beginning with 1.
    pub const ALL: [Self; 6] = [Self::B0, Self::B1, Self::B2, Self::A1, Self::A2, Self::A0];

    /// The register.
    #[must_use]
    #[inline]
    pub const fn reg(self) -> Reg {
        match self {
            Self::B0 => Reg::b(0),
            Self::B1 => Reg::b(1),
            Self::B2 => Reg::b(2),
            Self::A1 => Reg::a(1),
            Self::A2 => Reg::a(2),
            Self::A0 => Reg::a(0),
        }
    }

    /// The condition register that `reg` is, if it is one.
    #[must_use]
    pub fn from_reg(reg: Reg) -> Option<Self> {
        Self::ALL.into_iter().find(|pred| pred.reg() == reg)
    }

    fn creg(self) -> u32 {
        match self {
            Self::B0 => 1,
            Self::B1 => 2,
            Self::B2 => 3,
            Self::A1 => 4,
            Self::A2 => 5,
            Self::A0 => 6,
        }
    }
}

impl Pred {
    /// The condition in bits 31..28 of a word; `None` for a reserved pattern (creg 0 with z, creg 7).
    #[must_use]
    pub fn from_word(word: u32) -> Option<Self> {
        let negated = word >> 28 & 1 != 0;
        match word >> 29 {
            0 => (!negated).then_some(Self::Always),
            creg @ 1..=6 => {
                let reg = PredReg::ALL[creg as usize - 1];
                Some(if negated { Self::Unless(reg) } else { Self::If(reg) })
            }
            _ => None,
        }
    }

    /// Bits 31..28 of a word with this condition.
    #[must_use]
    pub fn bits(self) -> u32 {
        match self {
            Self::Always => 0,
            Self::If(reg) => reg.creg() << 29,
            Self::Unless(reg) => reg.creg() << 29 | 1 << 28,
        }
    }

    /// The register that is tested; `None` for [`Pred::Always`].
    #[must_use]
    #[inline]
    pub fn reg(self) -> Option<Reg> {
        match self {
            Self::Always => None,
            Self::If(reg) | Self::Unless(reg) => Some(reg.reg()),
        }
    }

    /// Reports whether two instructions with these conditions never execute in the same cycle.
    #[must_use]
    pub fn excludes(self, other: Self) -> bool {
        match (self, other) {
            (Self::If(a), Self::Unless(b)) | (Self::Unless(a), Self::If(b)) => a == b,
            (Self::Always | Self::If(_) | Self::Unless(_), _) => false,
        }
    }
}

impl fmt::Display for Pred {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Always => Ok(()),
            Self::If(reg) => write!(f, "[{}]", reg.reg()),
            Self::Unless(reg) => write!(f, "[!{}]", reg.reg()),
        }
    }
}

/// The kind of a functional unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum UnitKind {
    /// Sums, compares, logic, conversions; 40 bits.
    L,
    /// Shifts, bit fields, constants, branches, compares of floating-point values.
    S,
    /// Products.
    M,
    /// Addresses, loads, stores.
    D,
}

/// One of the eight functional units.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Unit {
    /// The kind of unit.
    pub kind: UnitKind,
    /// The side of the processor.
    pub side: Side,
}

impl Unit {
    /// The eight units.
    pub const ALL: [Self; 8] = {
        const fn unit(kind: UnitKind, side: Side) -> Unit {
            Unit { kind, side }
        }
        [
            unit(UnitKind::L, Side::A),
            unit(UnitKind::S, Side::A),
            unit(UnitKind::M, Side::A),
            unit(UnitKind::D, Side::A),
            unit(UnitKind::L, Side::B),
            unit(UnitKind::S, Side::B),
            unit(UnitKind::M, Side::B),
            unit(UnitKind::D, Side::B),
        ]
    };

    /// 0..=7 in the order of [`Unit::ALL`].
    #[must_use]
    #[inline]
    pub const fn index(self) -> usize {
        self.kind as usize + 4 * self.side.bit() as usize
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, ".{:?}{}", self.kind, self.side.number())
    }
}

macro_rules! define_control {
    ($($(#[doc = $doc:literal])* $name:ident = $number:literal, $read:literal, $write:literal;)*) => {
        /// A control register, reached by `MVC` on .S2.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Control {
            $($(#[doc = $doc])* $name,)*
        }

        impl Control {
            /// All control registers.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// The number in the word of an `MVC`.
            #[must_use]
            #[inline]
            pub const fn number(self) -> u32 {
                match self {
                    $(Self::$name => $number,)*
                }
            }

            /// The name when it is read, and the name when it is written.
            #[must_use]
            pub const fn names(self) -> (&'static str, &'static str) {
                match self {
                    $(Self::$name => ($read, $write),)*
                }
            }
        }
    };
}

define_control! {
    /// Addressing modes of A4..A7, B4..B7.
    Amr = 0, "AMR", "AMR";
    /// Control and status: bit 0 GIE, bit 1 PGIE, bit 9 SAT.
    Csr = 1, "CSR", "CSR";
    /// Pending interrupts; written, it sets them.
    Ifr = 2, "IFR", "ISR";
    /// Written, it clears pending interrupts.
    Icr = 3, "ICR", "ICR";
    /// Enabled interrupts.
    Ier = 4, "IER", "IER";
    /// Address of the table of interrupt vectors.
    Istp = 5, "ISTP", "ISTP";
    /// Return address of an interrupt.
    Irp = 6, "IRP", "IRP";
    /// Return address of the interrupt that cannot be masked.
    Nrp = 7, "NRP", "NRP";
    /// Address of the executing fetch packet.
    Pce1 = 16, "PCE1", "PCE1";
    /// Rounding modes and status of .L.
    Fadcr = 18, "FADCR", "FADCR";
    /// Status of the other floating-point instructions.
    Faucr = 19, "FAUCR", "FAUCR";
    /// Rounding modes and status of .M.
    Fmcr = 20, "FMCR", "FMCR";
}

impl Control {
    /// The control register with this number.
    #[must_use]
    pub fn from_number(number: u32) -> Option<Self> {
        Self::ALL.iter().copied().find(|control| control.number() == number)
    }
}
