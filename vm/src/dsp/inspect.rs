//! Views of a halted processor for people: its registers, the code around an address.

use c67x::{Control, Inst, PARALLEL, Reg};

use super::core::Core;
use crate::trap::Scene;

/// The stack pointer at the start of a board.
const STACK: Reg = Reg::b(15);
/// Most instructions of a packet.
const MOST: u32 = 8;
/// Bytes shown before an address, and from it on.
const AROUND: u32 = 8 * 4;
/// CSR at power-up: little endian, interrupts off.
const POWER_UP: u32 = 0x100;

impl Core {
    /// A processor at power-up before the packet at `pc`: registers 0 except for the stack pointer, interrupts off.
    ///
    /// The cycles continue from `cycle`.
    #[must_use]
    pub fn at_power_up(pc: u32, stack: u32, cycle: u64) -> Self {
        let mut core = Self::new(pc);
        core.state.set_control(Control::Csr, POWER_UP);
        core.state.set_control(Control::Ier, 0);
        core.state.set_reg(STACK, stack);
        core.state.clock.cycle = cycle;
        core
    }

    /// The registers by name: side A, side B, then the control registers of interest.
    #[must_use]
    pub fn registers(&self) -> Vec<(String, u32)> {
        let state = &self.state;
        let plain = (0..Reg::COUNT).filter_map(Reg::from_index).map(|reg| (reg.to_string(), state.reg(reg)));
        let control = [
            ("CSR", Control::Csr),
            ("IER", Control::Ier),
            ("IFR", Control::Ifr),
            ("ISTP", Control::Istp),
            ("IRP", Control::Irp),
        ];
        plain.chain(control.map(|(name, control)| (name.to_owned(), state.control(control)))).collect()
    }

    /// The registers, and the code around the word at `at`, as far as `fetch` has it.
    #[must_use]
    pub fn scene(&self, at: u32, fetch: impl Fn(u32) -> Option<u32>) -> Scene {
        let at = at & !3;
        let code = listing(at.saturating_sub(AROUND)..at.saturating_add(AROUND), fetch);
        Scene { at, registers: self.registers(), code }
    }
}

/// The instructions of the packet at `at`, bars between them, as far as `fetch` has them.
#[must_use]
pub fn packet_text(at: u32, fetch: impl Fn(u32) -> Option<u32>) -> String {
    let mut text = String::new();
    for at in (at..at.saturating_add(4 * MOST)).step_by(4) {
        let Some(word) = fetch(at) else { break };
        text += &Inst::decode(word).map_or_else(|_| "(no instruction)".to_owned(), |inst| inst.text(at));
        if word & PARALLEL == 0 {
            break;
        }
        text += " || ";
    }
    text
}

/// A line of text for each word of `range` that `fetch` has.
fn listing(range: std::ops::Range<u32>, fetch: impl Fn(u32) -> Option<u32>) -> Vec<(u32, String)> {
    let mut follows = false;
    let mut lines = Vec::new();
    for at in range.step_by(4) {
        let Some(word) = fetch(at) else { continue };
        let bars = if follows { "|| " } else { "   " };
        let text = Inst::decode(word).map_or_else(|_| "(no instruction)".to_owned(), |inst| inst.text(at));
        lines.push((at, format!("{word:08X}  {bars}{text}")));
        follows = word & PARALLEL != 0;
    }
    lines
}
