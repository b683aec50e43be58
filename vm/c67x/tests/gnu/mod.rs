//! Instructions in the notation of the GNU disassembler.

use c67x::{Inst, Kind, Operand, target};

/// The text as the GNU disassembler writes it, without blanks.
pub(crate) fn gnu_text(inst: Inst, at: u32) -> String {
    let bytes = inst.mnemonic().bytes().unwrap_or(1);
    let kinds = inst.op().row().operands.iter().map(|(_, kind)| *kind);
    let operands = inst.operands().zip(kinds).map(|(operand, kind)| match operand {
        Operand::Const(value) if kind == Kind::H16 => ((value as u32) << 16).to_string(),
        Operand::Target(distance) => format!("0x{:x}", target(at, distance)),
        Operand::Mem(mem) => match mem.offset {
            c67x::Offset::Const(offset) => {
                let text = mem.to_string();
                let (base, _) = text.split_once('[').expect("an offset");
                format!("{base}({})", u32::from(offset) * bytes)
            }
            c67x::Offset::Reg(_) => mem.to_string(),
        },
        Operand::Const(value) => value.to_string(),
        Operand::Reg(reg) => reg.to_string(),
        Operand::Pair(pair) => pair.to_string(),
        Operand::Control(control) => control.names().0.to_owned(),
        Operand::Irp => "irp".to_owned(),
        Operand::Nrp => "nrp".to_owned(),
    });
    let operands = operands.collect::<Vec<_>>().join(",").to_lowercase();
    let pred = inst.pred().to_string().to_lowercase();
    format!("{pred}{}{}{operands}", inst.mnemonic().name().to_lowercase(), inst.unit_text())
}
