//! The operation of an instruction, once its operands are resolved.
//!
//! Several forms of the table share one [`Work`]: sides, cross paths and constants are already resolved. The formulas
//! are those of the table (`c67x::Row::meaning`).

use c67x::{Inst, Kind, Mnemonic, Op, UnitKind};

use super::product::{Half, Halves};

macro_rules! works {
    ($($(#[doc = $doc:literal])* $name:ident,)*) => {
        /// An operation; s1 and s2 are the sources.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub(super) enum Work {
            $($(#[doc = $doc])* $name,)*
        }
    };
}

works! {
    /// `s1 + s2`
    Add,
    /// `s1 - s2`
    Sub,
    /// `s2 + (s1 << extra)`
    AddScaled,
    /// `s2 - (s1 << extra)`
    SubScaled,
    /// `s1 & s2`
    And,
    /// `s1 | s2`
    Or,
    /// `s1 ^ s2`
    Xor,
    /// `s1 == s2`
    Cmpeq,
    /// `s1 > s2`, signed
    Cmpgt,
    /// `s1 < s2`, signed
    Cmplt,
    /// `s1 > s2`, unsigned
    Cmpgtu,
    /// `s1 < s2`, unsigned
    Cmpltu,
    /// Absolute value, saturating.
    Abs,
    /// Place of the leftmost bit.
    Lmbd,
    /// Redundant sign bits.
    Norm,
    /// `sat32(s1 + s2)`
    Sadd,
    /// `sat32(s1 - s2)`
    Ssub,
    /// One step of a division.
    Subc,
    /// Two sums of 16 bits.
    Add2,
    /// Two differences of 16 bits.
    Sub2,
    /// Bits of s2 cleared.
    Clr,
    /// Bits of s2 set.
    Set,
    /// A signed bit field.
    Ext,
    /// An unsigned bit field.
    Extu,
    /// `s2 << s1`
    Shl,
    /// `s2 >> s1`, signed
    Shr,
    /// `s2 >> s1`, unsigned
    Shru,
    /// `sat32(s2 << s1)`
    Sshl,
    /// The constant.
    Mvk,
    /// The constant above the low half of dst.
    Mvkh,
    /// 40 bits: `s1 + s2`
    AddLong,
    /// 40 bits: `s1 - s2`
    SubLong,
    /// `sat40(s1 + s2)`
    SaddLong,
    /// `sat40(s1 - s2)`
    SsubLong,
    /// 40 bits: absolute value; the least stays.
    AbsLong,
    /// 40 bits: `s1 == s2`
    CmpeqLong,
    /// 40 bits: `s1 > s2`, signed
    CmpgtLong,
    /// 40 bits: `s1 < s2`, signed
    CmpltLong,
    /// 40 bits: `s1 > s2`, unsigned
    CmpgtuLong,
    /// 40 bits: `s1 < s2`, unsigned
    CmpltuLong,
    /// Redundant sign bits of 40.
    NormLong,
    /// `sat32(s2)` of 40 bits
    SatLong,
    /// 40 bits: `s2 << s1`
    ShlLong,
    /// 40 bits: `s2 >> s1`, signed
    ShrLong,
    /// 40 bits: `s2 >> s1`, unsigned
    ShruLong,
    /// Product of 16-bit halves; `extra` selects them.
    Product,
    /// `s1 * s2`, low word
    Mpyi,
    /// `s1 * s2`, 64 bits
    Mpyid,
    /// `s1 + s2`, single
    Addsp,
    /// `s1 - s2`, single
    Subsp,
    /// `s1 * s2`, single
    Mpysp,
    /// Signed integer to single.
    Intsp,
    /// Unsigned integer to single.
    Intspu,
    /// Single to integer, nearest.
    Spint,
    /// Single to integer, toward zero.
    Sptrunc,
    /// Double to integer, nearest.
    Dpint,
    /// Double to integer, toward zero.
    Dptrunc,
    /// Double to single.
    Dpsp,
    /// Signed integer to double.
    Intdp,
    /// Unsigned integer to double.
    Intdpu,
    /// Single to double.
    Spdp,
    /// Absolute value, single.
    Abssp,
    /// Absolute value, double.
    Absdp,
    /// `s1 == s2`, single
    Cmpeqsp,
    /// `s1 > s2`, single
    Cmpgtsp,
    /// `s1 < s2`, single
    Cmpltsp,
    /// Estimate of `1/s2`, single.
    Rcpsp,
    /// Estimate of `1/sqrt(s2)`, single.
    Rsqrsp,
    /// Estimate of `1/s2`, double.
    Rcpdp,
    /// Estimate of `1/sqrt(s2)`, double.
    Rsqrdp,
    /// `s1 + s2`, double; the high words are read a cycle later.
    Adddp,
    /// `s1 - s2`, double; reads its words as above.
    Subdp,
    /// `s1 == s2`, double; reads its words as above.
    Cmpeqdp,
    /// `s1 > s2`, double; reads its words as above.
    Cmpgtdp,
    /// `s1 < s2`, double; reads its words as above.
    Cmpltdp,
    /// `s1 * s2`, double; the high word of s2 is read a cycle later, the high word of s1 two cycles later.
    Mpydp,
    /// `single s1 * double s2`; the high word of s2 is read a cycle later.
    Mpyspdp,
    /// `single s1 * single s2`, double
    Mpysp2dp,
    /// A byte, zero-extended.
    Ldbu,
    /// A byte, sign-extended.
    Ldb,
    /// Two bytes, zero-extended.
    Ldhu,
    /// Two bytes, sign-extended.
    Ldh,
    /// A word.
    Ldw,
    /// Two words.
    Lddw,
    /// The low byte.
    Stb,
    /// The low two bytes.
    Sth,
    /// The word.
    Stw,
    /// Branch to a constant address.
    BranchTo,
    /// Branch to the address in a register.
    BranchRegister,
    /// Branch back from an interrupt.
    BranchIrp,
    /// Branch back from the interrupt that cannot be masked.
    BranchNrp,
    /// Control register to register.
    ReadControl,
    /// Register to control register.
    WriteControl,
    /// Waits for an interrupt.
    Idle,
    /// Nothing: the cycles of its packet pass.
    Nop,
}

/// The work of an instruction, and how its sources should be taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct WorkPlan {
    /// The operation.
    pub(super) work: Work,
    /// Shift of a scaled source, halves of a product.
    pub(super) extra: u8,
    /// True if s1 is `src2` and s2 is `src1`.
    pub(super) swaps: bool,
    /// True if a 32-bit source of 40-bit arithmetic is zero-extended.
    pub(super) is_unsigned: bool,
}

const fn plain(work: Work) -> WorkPlan {
    WorkPlan { work, extra: 0, swaps: false, is_unsigned: false }
}

const fn unsigned(work: Work) -> WorkPlan {
    WorkPlan { is_unsigned: true, ..plain(work) }
}

const fn scaled(work: Work, shift: u8) -> WorkPlan {
    WorkPlan { extra: shift, ..plain(work) }
}

const fn product(first: Half, second: Half) -> WorkPlan {
    WorkPlan { extra: Halves::new(first, second).bits(), ..plain(Work::Product) }
}

const fn saturating(first: Half, second: Half) -> WorkPlan {
    WorkPlan { extra: Halves::saturating(first, second).bits(), ..plain(Work::Product) }
}

/// The work of an instruction.
pub(super) fn plan(inst: Inst) -> WorkPlan {
    use Half::{High, Low, SignedHigh, SignedLow};
    let has_long = inst.op().row().operands.iter().any(|(_, kind)| *kind == Kind::L);
    let long = |short: Work, long: Work| plain(if has_long { long } else { short });
    match inst.mnemonic() {
        Mnemonic::Add | Mnemonic::Addk => long(Work::Add, Work::AddLong),
        Mnemonic::Addu => unsigned(Work::AddLong),
        Mnemonic::Sub if inst.op().row().unit == Some(UnitKind::D) => scaled(Work::SubScaled, 0),
        Mnemonic::Sub => long(Work::Sub, Work::SubLong),
        Mnemonic::Subu => unsigned(Work::SubLong),
        Mnemonic::Addab => scaled(Work::AddScaled, 0),
        Mnemonic::Addah => scaled(Work::AddScaled, 1),
        Mnemonic::Addaw => scaled(Work::AddScaled, 2),
        Mnemonic::Addad => scaled(Work::AddScaled, 3),
        Mnemonic::Subab => scaled(Work::SubScaled, 0),
        Mnemonic::Subah => scaled(Work::SubScaled, 1),
        Mnemonic::Subaw => scaled(Work::SubScaled, 2),
        Mnemonic::And => plain(Work::And),
        Mnemonic::Or => plain(Work::Or),
        Mnemonic::Xor => plain(Work::Xor),
        Mnemonic::Cmpeq => long(Work::Cmpeq, Work::CmpeqLong),
        Mnemonic::Cmpgt => long(Work::Cmpgt, Work::CmpgtLong),
        Mnemonic::Cmplt => long(Work::Cmplt, Work::CmpltLong),
        Mnemonic::Cmpgtu if has_long => unsigned(Work::CmpgtuLong),
        Mnemonic::Cmpgtu => plain(Work::Cmpgtu),
        Mnemonic::Cmpltu if has_long => unsigned(Work::CmpltuLong),
        Mnemonic::Cmpltu => plain(Work::Cmpltu),
        Mnemonic::Abs => long(Work::Abs, Work::AbsLong),
        Mnemonic::Lmbd => plain(Work::Lmbd),
        Mnemonic::Norm => long(Work::Norm, Work::NormLong),
        Mnemonic::Sadd => long(Work::Sadd, Work::SaddLong),
        Mnemonic::Ssub => long(Work::Ssub, Work::SsubLong),
        Mnemonic::Sat => plain(Work::SatLong),
        Mnemonic::Subc => plain(Work::Subc),
        Mnemonic::Add2 => plain(Work::Add2),
        Mnemonic::Sub2 => plain(Work::Sub2),
        Mnemonic::Clr => plain(Work::Clr),
        Mnemonic::Set => plain(Work::Set),
        Mnemonic::Ext => plain(Work::Ext),
        Mnemonic::Extu => plain(Work::Extu),
        Mnemonic::Shl if has_long => unsigned(Work::ShlLong),
        Mnemonic::Shl => plain(Work::Shl),
        Mnemonic::Shr => long(Work::Shr, Work::ShrLong),
        Mnemonic::Shru => long(Work::Shru, Work::ShruLong),
        Mnemonic::Sshl => plain(Work::Sshl),
        Mnemonic::Mvk => plain(Work::Mvk),
        Mnemonic::Mvkh => plain(Work::Mvkh),
        Mnemonic::Mpy => product(SignedLow, SignedLow),
        Mnemonic::Mpyu => product(Low, Low),
        Mnemonic::Mpyus => product(Low, SignedLow),
        Mnemonic::Mpysu => product(SignedLow, Low),
        Mnemonic::Mpyh => product(SignedHigh, SignedHigh),
        Mnemonic::Mpyhu => product(High, High),
        Mnemonic::Mpyhus => product(High, SignedHigh),
        Mnemonic::Mpyhsu => product(SignedHigh, High),
        Mnemonic::Mpyhl => product(SignedHigh, SignedLow),
        Mnemonic::Mpyhlu => product(High, Low),
        Mnemonic::Mpyhuls => product(High, SignedLow),
        Mnemonic::Mpyhslu => product(SignedHigh, Low),
        Mnemonic::Mpylh => product(SignedLow, SignedHigh),
        Mnemonic::Mpylhu => product(Low, High),
        Mnemonic::Mpyluhs => product(Low, SignedHigh),
        Mnemonic::Mpylshu => product(SignedLow, High),
        Mnemonic::Smpy => saturating(SignedLow, SignedLow),
        Mnemonic::Smpyh => saturating(SignedHigh, SignedHigh),
        Mnemonic::Smpyhl => saturating(SignedHigh, SignedLow),
        Mnemonic::Smpylh => saturating(SignedLow, SignedHigh),
        Mnemonic::Mpyi => plain(Work::Mpyi),
        Mnemonic::Mpyid => plain(Work::Mpyid),
        Mnemonic::Addsp => plain(Work::Addsp),
        Mnemonic::Subsp => WorkPlan { swaps: inst.op() == Op::SubspSRXrRRev, ..plain(Work::Subsp) },
        Mnemonic::Mpysp => plain(Work::Mpysp),
        Mnemonic::Intsp => plain(Work::Intsp),
        Mnemonic::Intspu => plain(Work::Intspu),
        Mnemonic::Spint => plain(Work::Spint),
        Mnemonic::Sptrunc => plain(Work::Sptrunc),
        Mnemonic::Dpint => plain(Work::Dpint),
        Mnemonic::Dptrunc => plain(Work::Dptrunc),
        Mnemonic::Dpsp => plain(Work::Dpsp),
        Mnemonic::Intdp => plain(Work::Intdp),
        Mnemonic::Intdpu => plain(Work::Intdpu),
        Mnemonic::Spdp => plain(Work::Spdp),
        Mnemonic::Abssp => plain(Work::Abssp),
        Mnemonic::Absdp => plain(Work::Absdp),
        Mnemonic::Cmpeqsp => plain(Work::Cmpeqsp),
        Mnemonic::Cmpgtsp => plain(Work::Cmpgtsp),
        Mnemonic::Cmpltsp => plain(Work::Cmpltsp),
        Mnemonic::Rcpsp => plain(Work::Rcpsp),
        Mnemonic::Rsqrsp => plain(Work::Rsqrsp),
        Mnemonic::Rcpdp => plain(Work::Rcpdp),
        Mnemonic::Rsqrdp => plain(Work::Rsqrdp),
        Mnemonic::Adddp => plain(Work::Adddp),
        Mnemonic::Subdp => WorkPlan { swaps: inst.op() == Op::SubdpSDXdDRev, ..plain(Work::Subdp) },
        Mnemonic::Cmpeqdp => plain(Work::Cmpeqdp),
        Mnemonic::Cmpgtdp => plain(Work::Cmpgtdp),
        Mnemonic::Cmpltdp => plain(Work::Cmpltdp),
        Mnemonic::Mpydp => plain(Work::Mpydp),
        Mnemonic::Mpyspdp => plain(Work::Mpyspdp),
        Mnemonic::Mpysp2dp => plain(Work::Mpysp2dp),
        Mnemonic::Ldbu => plain(Work::Ldbu),
        Mnemonic::Ldb => plain(Work::Ldb),
        Mnemonic::Ldhu => plain(Work::Ldhu),
        Mnemonic::Ldh => plain(Work::Ldh),
        Mnemonic::Ldw => plain(Work::Ldw),
        Mnemonic::Lddw => plain(Work::Lddw),
        Mnemonic::Stb => plain(Work::Stb),
        Mnemonic::Sth => plain(Work::Sth),
        Mnemonic::Stw => plain(Work::Stw),
        Mnemonic::B => match inst.branch() {
            Some(c67x::Branch::Near { .. }) | None => plain(Work::BranchTo),
            Some(c67x::Branch::Register(_)) => plain(Work::BranchRegister),
            Some(c67x::Branch::Interrupt) if inst.op() == Op::BNrp => plain(Work::BranchNrp),
            Some(c67x::Branch::Interrupt) => plain(Work::BranchIrp),
        },
        Mnemonic::Mvc if inst.op() == Op::MvcRead => plain(Work::ReadControl),
        Mnemonic::Mvc => plain(Work::WriteControl),
        Mnemonic::Idle => plain(Work::Idle),
        Mnemonic::Nop => plain(Work::Nop),
    }
}
