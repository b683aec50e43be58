//! Instructions as text.
//!
//! `|| [!A1] LDW .D1T2 *+A4[3],B5`: bars for an instruction that executes in parallel with
//! the one before it, the condition, the name, the unit with its cross or data path, the
//! operands. What is printed here [`crate::assemble`] reads back to the same word: where
//! the text alone would give another one (a field that the processor ignores, a second
//! form for the same operands), the word follows in braces.

use std::fmt;

use crate::alias::Alias;
use crate::assemble::assemble;
use crate::inst::Inst;
use crate::kind::Kind;
use crate::operand::Operand;

/// Length of a fetch packet in bytes; displacements count from its start.
pub const FETCH_PACKET: u32 = 32;

impl Inst {
    /// The text of the instruction at an address: branches show where they go.
    #[must_use]
    pub fn text(self, at: u32) -> String {
        self.print(Some(at))
    }

    /// The unit as it is written: `.L1X`, `.D1T2`; empty for `NOP` and `IDLE`.
    #[must_use]
    pub fn unit_text(self) -> String {
        let Some(unit) = self.unit() else { return String::new() };
        match (self.cross_path(), self.data_path()) {
            (Some(_), _) => format!("{unit}X"),
            (None, Some(path)) => format!("{unit}T{}", path.number()),
            (None, None) => unit.to_string(),
        }
    }

    fn print(self, at: Option<u32>) -> String {
        let plain = self.plain_text(at);
        match assemble(&plain, at.unwrap_or(0)) {
            Ok(line) if line.inst == self => plain,
            _ => format!("{plain} {{{:08X}}}", self.encode(false)),
        }
    }

    /// The text without the word in braces.
    pub(crate) fn plain_text(self, at: Option<u32>) -> String {
        let alias = Alias::of(self);
        let name = alias.map_or(self.mnemonic().name(), Alias::name);
        let hidden = alias.map(|alias| alias.hidden_operand(self));
        let mut parts = Vec::new();
        let pred = self.pred().to_string();
        let unit = self.unit_text();
        parts.extend([pred.as_str(), name, unit.as_str()].into_iter().filter(|part| !part.is_empty()));
        let kinds = self.op().row().operands.iter().map(|(_, kind)| *kind);
        let operands: Vec<String> = (0..)
            .zip(self.operands().zip(kinds))
            .filter(|(index, _)| Some(*index) != hidden)
            .map(|(_, (operand, kind))| operand_text(operand, kind, at))
            .collect();
        let operands = operands.join(",");
        // A NOP of one cycle is written without its count.
        let is_plain_nop = operands == "1" && self.unit().is_none();
        if !operands.is_empty() && !is_plain_nop {
            parts.push(&operands);
        }
        parts.join(" ")
    }
}

fn operand_text(operand: Operand, kind: Kind, at: Option<u32>) -> String {
    match operand {
        Operand::Reg(reg) => reg.to_string(),
        Operand::Pair(pair) => pair.to_string(),
        Operand::Const(upper) if kind == Kind::H16 => format!("0x{:X}", (upper as u32) << 16),
        Operand::Const(value) => value.to_string(),
        Operand::Target(bytes) => match at {
            Some(at) => format!("0x{:08X}", target(at, bytes)),
            None => format!("pc{bytes:+}"),
        },
        Operand::Mem(mem) => mem.to_string(),
        Operand::Control(control) => {
            let (read, write) = control.names();
            if kind == Kind::Crw { write.to_owned() } else { read.to_owned() }
        }
        Operand::Irp => "IRP".to_owned(),
        Operand::Nrp => "NRP".to_owned(),
    }
}

/// The address that a branch at `at` goes to, `bytes` from the start of its fetch packet.
#[must_use]
pub fn target(at: u32, bytes: i32) -> u32 {
    (at & !(FETCH_PACKET - 1)).wrapping_add_signed(bytes)
}

impl fmt::Display for Inst {
    /// The text without an address: a branch shows its distance from its fetch packet, `pc+16`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.print(None))
    }
}

impl fmt::Debug for Inst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self} ({:08X}, {})", self.encode(false), self.op().id())
    }
}
