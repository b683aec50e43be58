//! The forms in the processor's table for each kind of instruction.
//!
//! One row per kind: the forms, with operands by field; `swapped` exchanges the two sources. All forms of a row compute
//! the same result in the same time, so the scheduler may choose any that fits the registers.

use c67x::Op;

/// A form, and whether its sources are exchanged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub(super) op: Op,
    pub(super) is_swapped: bool,
}

macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $kind:ident = [$($op:ident $($swapped:ident)?),*];)*) => {
        /// The operation of an instruction.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub(super) enum Kind {
            $($(#[doc = $doc])* $kind,)*
        }

        impl Kind {
            /// The forms that can do it.
            pub(super) const fn forms(self) -> &'static [Form] {
                match self {
                    $(Self::$kind => &[$(Form { op: Op::$op, is_swapped: kinds!(@ $($swapped)?) }),*],)*
                }
            }
        }
    };
    (@) => { false };
    (@ swapped) => { true };
}

kinds! {
    /// Nothing: the whole of a pair counts as written from here on.
    Begin = [];
    /// A call, by number.
    Call = [];
    /// The address of an object in the frame.
    FrameAddress = [];
    /// `dst = src1 + src2`; a constant of 16 bits is src1.
    Add = [AddLRXrR, AddSRXrR, AddDRRR, AddLRXrR swapped, AddSRXrR swapped, AddLC5XrR, AddSC5XrR, AddDU5RR, Addk];
    /// `dst = src1 - src2`; a constant is src1.
    Sub = [SubLRXrR, SubSRXrR, SubLXrRR, SubDRRR swapped, SubLC5XrR, SubSC5XrR];
    /// `dst = src2`; src1 is the constant 0.
    Move = [AddDU5RR, AddLC5XrR, AddSC5XrR];
    /// `dst = src1 & src2`; a constant is src1.
    And = [AndLRXrR, AndSRXrR, AndLRXrR swapped, AndSRXrR swapped, AndLC5XrR, AndSC5XrR];
    /// `dst = src1 | src2`; a constant is src1.
    Or = [OrLRXrR, OrSRXrR, OrLRXrR swapped, OrSRXrR swapped, OrLC5XrR, OrSC5XrR];
    /// `dst = src1 ^ src2`; a constant is src1.
    Xor = [XorLRXrR, XorSRXrR, XorLRXrR swapped, XorSRXrR swapped, XorLC5XrR, XorSC5XrR];
    /// `dst = src2 << src1`
    Shl = [ShlSRXrR, ShlSU5XrR];
    /// `dst = src2 >> src1`, arithmetic
    Shr = [ShrSRXrR, ShrSU5XrR];
    /// `dst = src2 >> src1`, logical
    Shru = [ShruSRXrR, ShruSU5XrR];
    /// A field of src2, sign-extended.
    Ext = [ExtSRU5U5R];
    /// A field of src2, zero-extended.
    Extu = [ExtuSRU5U5R];
    /// src2 with a field cleared.
    Clr = [ClrSRU5U5R];
    /// The low half of a constant, sign-extended.
    Mvk = [Mvk];
    /// The high half of a constant over that of the destination.
    Mvkh = [Mvkh];
    /// `dst = dst + src1`, a constant of 16 bits
    Addk = [Addk];
    /// `dst = src1 == src2`
    CmpEq = [CmpeqLRXrR, CmpeqLRXrR swapped, CmpeqLC5XrR];
    /// `dst = src1 < src2`, signed
    CmpLt = [CmpltLRXrR, CmpgtLRXrR swapped, CmpltLC5XrR];
    /// `dst = src1 > src2`, signed
    CmpGt = [CmpgtLRXrR, CmpltLRXrR swapped, CmpgtLC5XrR];
    /// `dst = src1 < src2`, unsigned
    CmpLtu = [CmpltuLRXrR, CmpgtuLRXrR swapped, CmpltuLU4XrR];
    /// `dst = src1 > src2`, unsigned
    CmpGtu = [CmpgtuLRXrR, CmpltuLRXrR swapped, CmpgtuLU4XrR];
    /// `dst = src1 * src2`, 32 bits
    Mpyi = [MpyiMRXrR, MpyiMRXrR swapped, MpyiMC5XrR];
    /// `dst = src1 * src2`, signed, 64 bits
    Mpyid = [MpyidMRXrD, MpyidMRXrD swapped, MpyidMC5XrD];
    /// `dst = src1 + src2`, singles
    AddSp = [AddspLRXrR, AddspLRXrR swapped, AddspSRXrR, AddspSRXrR swapped];
    /// `dst = src1 - src2`, singles
    SubSp = [SubspLRXrR, SubspLXrRR];
    /// `dst = src1 * src2`, singles
    MpySp = [MpyspMRXrR, MpyspMRXrR swapped];
    /// `dst = src1 + src2`, doubles
    AddDp = [AdddpLDXdD, AdddpLDXdD swapped, AdddpSDXdD, AdddpSDXdD swapped];
    /// `dst = src1 - src2`, doubles
    SubDp = [SubdpLDXdD, SubdpLXdDD];
    /// `dst = src1 * src2`, doubles
    MpyDp = [MpydpMDXdD, MpydpMDXdD swapped];
    /// `dst = src1 == src2`, singles
    CmpEqSp = [CmpeqspSRXrR, CmpeqspSRXrR swapped];
    /// `dst = src1 < src2`, singles
    CmpLtSp = [CmpltspSRXrR, CmpgtspSRXrR swapped];
    /// `dst = src1 == src2`, doubles
    CmpEqDp = [CmpeqdpSDXdR, CmpeqdpSDXdR swapped];
    /// `dst = src1 < src2`, doubles
    CmpLtDp = [CmpltdpSDXdR, CmpgtdpSDXdR swapped];
    /// An integer to a single.
    IntSp = [IntspLXrR];
    /// An unsigned integer to a single.
    IntSpu = [IntspuLXrR];
    /// An integer to a double.
    IntDp = [IntdpLXrD];
    /// An unsigned integer to a double.
    IntDpu = [IntdpuLXrD];
    /// A single to an integer, toward zero.
    SpTrunc = [SptruncLXrR];
    /// A double to an integer, toward zero.
    DpTrunc = [DptruncLDR];
    /// A single to a double.
    SpDp = [SpdpSXrD];
    /// A double to a single.
    DpSp = [DpspLDR];
    /// Loads 8 bits, sign-extended.
    LoadI8 = [LdbPosC, LdbNegC, LdbPosR, LdbPosU15, LdbPostincC, LdbPostdecC];
    /// Loads 8 bits, zero-extended.
    LoadU8 = [LdbuPosC, LdbuNegC, LdbuPosR, LdbuPosU15, LdbuPostincC, LdbuPostdecC];
    /// Loads 16 bits, sign-extended.
    LoadI16 = [LdhPosC, LdhNegC, LdhPosR, LdhPosU15, LdhPostincC, LdhPostdecC];
    /// Loads 16 bits, zero-extended.
    LoadU16 = [LdhuPosC, LdhuNegC, LdhuPosR, LdhuPosU15, LdhuPostincC, LdhuPostdecC];
    /// Loads 32 bits.
    LoadWord = [LdwPosC, LdwNegC, LdwPosR, LdwPosU15, LdwPostincC, LdwPostdecC];
    /// Loads a pair.
    LoadPair = [LddwPosC, LddwNegC, LddwPosR, LddwPostincC, LddwPostdecC];
    /// Stores 8 bits; the register is src2.
    StoreByte = [StbPosC, StbNegC, StbPosR, StbPosU15, StbPostincC, StbPostdecC];
    /// Stores 16 bits.
    StoreHalf = [SthPosC, SthNegC, SthPosR, SthPosU15, SthPostincC, SthPostdecC];
    /// Stores 32 bits.
    StoreWord = [StwPosC, StwNegC, StwPosR, StwPosU15, StwPostincC, StwPostdecC];
    /// Branches to a block, a symbol, or the address in a register (src2).
    Branch = [BDisp, BReg];
}

impl Kind {
    /// Bytes that a load or store moves.
    pub(super) const fn bytes(self) -> Option<u32> {
        match self {
            Self::LoadI8 | Self::LoadU8 | Self::StoreByte => Some(1),
            Self::LoadI16 | Self::LoadU16 | Self::StoreHalf => Some(2),
            Self::LoadWord | Self::StoreWord => Some(4),
            Self::LoadPair => Some(8),
            _ => None,
        }
    }

    /// Reports whether it is a store.
    pub(super) const fn is_store(self) -> bool {
        matches!(self, Self::StoreByte | Self::StoreHalf | Self::StoreWord)
    }

    /// The sources that may come from the other register file.
    pub(super) const fn crossing(self) -> Crossing {
        match self {
            Self::Shl | Self::Shr | Self::Shru => Crossing::Second,
            Self::Ext | Self::Extu | Self::Clr | Self::DpTrunc | Self::DpSp => Crossing::Neither,
            _ => Crossing::One,
        }
    }
}

/// The sources of an instruction that may come from the other register file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crossing {
    /// Either of the two, but not both.
    One,
    /// The second alone.
    Second,
    /// None.
    Neither,
}
