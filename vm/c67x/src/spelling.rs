//! The text of an instruction's parts: unit, operands, the target of a branch.
//!
//! [`Inst::plain_text`] may be ambiguous; in that case `text` adds the word.

use crate::alias::Alias;
use crate::inst::Inst;
use crate::kind::Kind;
use crate::operand::Operand;

/// Length of a fetch packet in bytes; displacements count from its start.
pub const FETCH_PACKET: u32 = 32;

impl Inst {
    /// The unit in the text: `.L1X`, `.D1T2`; empty for `NOP` and `IDLE`.
    #[must_use]
    pub fn unit_text(self) -> String {
        let Some(unit) = self.unit() else { return String::new() };
        match (self.cross_path(), self.data_path()) {
            (Some(_), _) => format!("{unit}X"),
            (None, Some(path)) => format!("{unit}T{}", path.number()),
            (None, None) => unit.to_string(),
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

/// The address of the target of a branch at `at`, `bytes` from the start of its fetch packet.
#[must_use]
pub fn target(at: u32, bytes: i32) -> u32 {
    (at & !(FETCH_PACKET - 1)).wrapping_add_signed(bytes)
}
