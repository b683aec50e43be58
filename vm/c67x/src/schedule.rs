//! Checks packets against the rules of the pipeline.
//!
//! It is independent of the generator of the code: [`check`] takes packets with their addresses, checks each one by
//! itself, then follows every path from the entries cycle by cycle, with the results in flight, and reports every rule
//! that a path violates. The processor itself checks none of them: invalid code gives wrong or unpredictable results.
//!
//! It cannot check addresses in registers (whether a load and a store in one packet overlap), or the correlation of two
//! conditional branches: it follows both ways of each.

mod flow;
mod packet;

use std::fmt;

use crate::inst::{BadWord, Inst, PARALLEL};
use crate::register::{Reg, Side, Unit};

/// Instructions that issue in one cycle, in the order of their words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Packet {
    /// The instructions, one to eight.
    pub insts: Vec<Inst>,
}

impl Packet {
    /// Its words; bit p is set in all except the last.
    pub fn words(&self) -> impl Iterator<Item = u32> {
        let last = self.insts.len().saturating_sub(1);
        self.insts.iter().enumerate().map(move |(index, inst)| inst.encode(index < last))
    }

    /// Its size in bytes.
    #[must_use]
    pub fn bytes(&self) -> u32 {
        self.insts.len() as u32 * 4
    }

    /// The number of cycles that it takes if no branch arrives.
    #[must_use]
    pub fn cycles(&self) -> u32 {
        self.insts.iter().map(|inst| inst.cycles()).max().unwrap_or(1)
    }
}

/// The packets of a sequence of words.
///
/// # Errors
/// One of the words is not an instruction.
pub fn packets(words: &[u32]) -> Result<Vec<Packet>, BadWord> {
    let mut all = vec![Packet { insts: Vec::new() }];
    for (index, word) in words.iter().enumerate() {
        if let Some(packet) = all.last_mut() {
            packet.insts.push(Inst::decode(*word)?);
        }
        if word & PARALLEL == 0 && index + 1 < words.len() {
            all.push(Packet { insts: Vec::new() });
        }
    }
    all.retain(|packet| !packet.insts.is_empty());
    Ok(all)
}

/// A violated rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// More than eight instructions.
    TooMany,
    /// The packet crosses a boundary of 32 bytes.
    CrossesFetchPacket,
    /// Two instructions on one unit.
    UnitTwice(Unit),
    /// The unit is still locked by an instruction with a functional unit latency.
    UnitLocked(Unit),
    /// Two instructions use the cross path of this side.
    CrossPathTwice(Side),
    /// The cross path is still locked.
    CrossPathLocked(Side),
    /// Two loads or stores use the data path of this side.
    DataPathTwice(Side),
    /// More than four operands read one register.
    TooManyReads(Reg),
    /// Two 40-bit sources, or two 40-bit results, on one side.
    LongTwice(Side),
    /// A 40-bit source on a side from which a store takes its data.
    LongWithStore(Side),
    /// Two `NOP`s of more than one cycle.
    NopTwice,
    /// A load and a store of the same bytes.
    LoadMeetsStore,
    /// A store of the register that it modifies as its base.
    StoresItsBase,
    /// Two branches that can be taken together.
    TwoBranches,
    /// Two results of one register become visible in one cycle.
    TwoResults(Reg),
    /// Two results of one unit are written in one cycle.
    WritePort(Unit),
    /// The register is read while a result for it is in flight, at a point where an interrupt may occur.
    EarlyRead(Reg),
    /// The register changes while an instruction reads it over several cycles.
    ChangesDuringRead(Reg),
    /// A long multiply too soon after a different one on the same unit.
    LongMultiplies(Unit),
    /// A branch into the middle of a packet.
    IntoPacket(u32),
    /// A result is in flight when a call or return leaves the code.
    InFlight(Reg),
    /// Execution runs beyond the last packet.
    RunsOut,
    /// More than [`LONGEST_SHADOW`] cycles without a point at which an interrupt can be taken.
    NotInterruptible,
    /// The code has more paths than can be followed.
    TooComplex,
}

/// The number of cycles without an interruptible point that is harmless: 1 µs.
pub const LONGEST_SHADOW: u32 = 200;

/// A violated rule, with the packet that violates it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Violation {
    /// Address of the packet.
    pub at: u32,
    /// The rule.
    pub rule: Rule,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:08X}: {}", self.at, self.rule)
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooMany => f.write_str("more than eight instructions in one packet"),
            Self::CrossesFetchPacket => f.write_str("the packet crosses a boundary of 32 bytes"),
            Self::UnitTwice(unit) => write!(f, "two instructions on {unit}"),
            Self::UnitLocked(unit) => write!(f, "{unit} is still locked by an instruction before"),
            Self::CrossPathTwice(side) => write!(f, "two uses of cross path {}X", side.number()),
            Self::CrossPathLocked(side) => write!(f, "cross path {}X is still locked", side.number()),
            Self::DataPathTwice(side) => write!(f, "two uses of data path T{}", side.number()),
            Self::TooManyReads(reg) => write!(f, "more than four operands read {reg}"),
            Self::LongTwice(side) => write!(f, "two 40-bit sources or results on side {side}"),
            Self::LongWithStore(side) => write!(f, "a 40-bit source and a store from side {side}"),
            Self::NopTwice => f.write_str("two NOPs of several cycles"),
            Self::LoadMeetsStore => f.write_str("a load and a store of the same bytes in one packet"),
            Self::StoresItsBase => f.write_str("a store of the register that it changes as its base"),
            Self::TwoBranches => f.write_str("two branches can be taken in one packet"),
            Self::TwoResults(reg) => write!(f, "two results reach {reg} in the same cycle"),
            Self::WritePort(unit) => write!(f, "two results of {unit} are written in the same cycle"),
            Self::EarlyRead(reg) => write!(f, "{reg} is read while a result for it is in flight"),
            Self::ChangesDuringRead(reg) => write!(f, "{reg} changes while it is read in several cycles"),
            Self::LongMultiplies(unit) => write!(f, "{unit}: a long multiply too soon after a different one"),
            Self::IntoPacket(target) => write!(f, "branch to {target:08X}, where no packet starts"),
            Self::InFlight(reg) => write!(f, "a result for {reg} is in flight at a call or return"),
            Self::RunsOut => f.write_str("execution runs beyond the last packet"),
            Self::NotInterruptible => {
                write!(f, "more than {LONGEST_SHADOW} cycles without an interruptible point")
            }
            Self::TooComplex => f.write_str("the code has too many paths to be followed"),
        }
    }
}

/// All rules that the code violates, by address, without duplicates.
///
/// `base` is the address of the first packet; the others follow without gaps. `entries` are the addresses at which
/// execution can begin with nothing in flight: functions, and the return addresses of calls. Branches within the code
/// are followed; a branch through a register, or out of the code, ends a path.
#[must_use]
pub fn check(base: u32, packets: &[Packet], entries: &[u32]) -> Vec<Violation> {
    let mut found: Vec<Violation> = Vec::new();
    let mut at = base;
    for packet in packets {
        found.extend(packet::rules(at, packet).into_iter().map(|rule| Violation { at, rule }));
        at += packet.bytes();
    }
    found.extend(flow::walk(base, packets, entries));
    found.sort();
    found.dedup();
    found
}
