//! Additional names for the assembler: `MV`, `NEG`, `NOT`.
//!
//! Each is an instruction with one constant operand, which is omitted in the text.

use crate::inst::Inst;
use crate::kind::Kind;
use crate::mnemonic::Mnemonic;
use crate::operand::Operand;
use crate::register::UnitKind;

/// A second name for an instruction with a particular constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Alias {
    name: &'static str,
    mnemonic: Mnemonic,
    constant: i32,
    /// True if it also exists on the .D unit, where the constant is the second operand.
    on_d: bool,
}

const ALIASES: [Alias; 3] = [
    Alias { name: "MV", mnemonic: Mnemonic::Add, constant: 0, on_d: true },
    Alias { name: "NEG", mnemonic: Mnemonic::Sub, constant: 0, on_d: false },
    Alias { name: "NOT", mnemonic: Mnemonic::Xor, constant: -1, on_d: false },
];

impl Alias {
    /// The other name of an instruction, if it has one.
    pub(crate) fn of(inst: Inst) -> Option<Self> {
        ALIASES.into_iter().find(|alias| {
            alias.mnemonic == inst.mnemonic() && alias.takes(inst) && {
                let hidden = inst.operands().nth(alias.hidden_operand(inst));
                hidden == Some(Operand::Const(alias.constant))
            }
        })
    }

    /// The alias with this name, in any case.
    pub(crate) fn from_name(name: &str) -> Option<Self> {
        ALIASES.into_iter().find(|alias| alias.name.eq_ignore_ascii_case(name))
    }

    pub(crate) fn name(self) -> &'static str {
        self.name
    }

    pub(crate) fn mnemonic(self) -> Mnemonic {
        self.mnemonic
    }

    /// The operands with the constant inserted: for .L and .S, and for .D.
    pub(crate) fn complete(self, operands: &[Operand]) -> Vec<Vec<Operand>> {
        let with = |at: usize| {
            let mut all = operands.to_vec();
            all.insert(at.min(all.len()), Operand::Const(self.constant));
            all
        };
        if self.on_d { vec![with(0), with(1)] } else { vec![with(0)] }
    }

    /// The index of the constant in the operands of the instruction.
    pub(crate) fn hidden_operand(self, inst: Inst) -> usize {
        usize::from(inst.op().row().unit == Some(UnitKind::D))
    }

    /// Reports whether the form has a 5-bit constant as this operand, and two 32-bit registers.
    fn takes(self, inst: Inst) -> bool {
        let row = inst.op().row();
        let simple =
            row.operands.iter().all(|(_, kind)| matches!(kind, Kind::C5 | Kind::U5 | Kind::R | Kind::Xr));
        simple && (self.on_d || row.unit != Some(UnitKind::D))
    }
}
