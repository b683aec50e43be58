//! A processor with a thread's memory, and the result of a run on it.

use kmotiondef::GuestAddr;
use vm::dsp::{Clock, Core, Halt, Memory};
use vm::trap::TrapKind;

use super::firmware;
use crate::link::LinkedProgram;

const PAGE: usize = 4096;

/// The address at which the firmware ends a thread.
pub(super) const THREAD_DONE: u32 = 0x1000_0040;
/// The maximum number of cycles of a run.
const MOST_CYCLES: i64 = 400_000_000;
/// The stack pointer of thread 1.
const STACK: u32 = 0x1001_3C78;

/// Memory of the whole address space, page by page.
#[derive(Default)]
pub(super) struct Ram {
    pages: std::collections::BTreeMap<u32, Box<[u8; PAGE]>>,
    code: std::ops::Range<u32>,
}

impl Ram {
    pub(super) fn byte(&self, at: u32) -> u8 {
        self.pages.get(&(at / PAGE as u32)).map_or(0, |page| page[at as usize % PAGE])
    }

    pub(super) fn set(&mut self, at: u32, byte: u8) {
        self.pages.entry(at / PAGE as u32).or_insert_with(|| Box::new([0; PAGE]))[at as usize % PAGE] = byte;
    }

    pub(super) fn word(&self, at: u32) -> u32 {
        (0..4).rev().fold(0, |word, index| word << 8 | u32::from(self.byte(at + index)))
    }

    pub(super) fn set_bytes(&mut self, at: u32, bytes: &[u8]) {
        for (at, byte) in (at..).zip(bytes) {
            self.set(at, *byte);
        }
    }

    pub(super) fn text(&self, at: u32) -> String {
        (at..).map(|at| self.byte(at)).take_while(|byte| *byte != 0).map(char::from).collect()
    }
}

impl Memory for Ram {
    fn fetch(&self, addr: u32) -> Option<u32> {
        self.code.contains(&addr).then(|| self.word(addr))
    }

    fn load8(&mut self, addr: u32, _: &mut Clock) -> Result<u32, TrapKind> {
        Ok(self.byte(addr).into())
    }

    fn load16(&mut self, addr: u32, _: &mut Clock) -> Result<u32, TrapKind> {
        Ok(self.word(addr) & 0xFFFF)
    }

    fn load32(&mut self, addr: u32, _: &mut Clock) -> Result<u32, TrapKind> {
        Ok(self.word(addr))
    }

    fn load64(&mut self, addr: u32, _: &mut Clock) -> Result<u64, TrapKind> {
        Ok(u64::from(self.word(addr)) | u64::from(self.word(addr + 4)) << 32)
    }

    fn store8(&mut self, addr: u32, value: u32, _: &mut Clock) -> Result<(), TrapKind> {
        self.set_bytes(addr, &value.to_le_bytes()[..1]);
        Ok(())
    }

    fn store16(&mut self, addr: u32, value: u32, _: &mut Clock) -> Result<(), TrapKind> {
        self.set_bytes(addr, &value.to_le_bytes()[..2]);
        Ok(())
    }

    fn store32(&mut self, addr: u32, value: u32, _: &mut Clock) -> Result<(), TrapKind> {
        self.set_bytes(addr, &value.to_le_bytes());
        Ok(())
    }
}

/// The result of a run.
#[derive(Debug, Default)]
pub(super) struct Run {
    pub(super) console: String,
    pub(super) result: i32,
    pub(super) cycles: u64,
}

/// A call of a function of a program, without a caller.
pub(super) struct Call {
    pub(super) core: Core,
    pub(super) ram: Ram,
}

impl Call {
    /// Prepares the call at the first packet of the function, with random values in the registers.
    pub(super) fn new(linked: &LinkedProgram, name: &str) -> Self {
        let function = linked.symbols.iter().find(|symbol| symbol.name == name).expect("a function");
        let mut core = Core::new(function.address.get());
        scramble(&mut core, !0, 1);
        core.state.set_reg(c67x::Reg::b(15), STACK);
        core.state.set_reg(c67x::Reg::b(3), THREAD_DONE);
        Self { core, ram: loaded(linked) }
    }

    /// The cycles up to the return.
    pub(super) fn run(&mut self) -> u64 {
        self.core.state.clock.set_left(MOST_CYCLES);
        assert_eq!(self.core.run(&mut self.ram), Halt::Left(THREAD_DONE));
        self.core.state.cycle()
    }

    /// Runs up to the return; at each point where an interrupt can be taken, all results in flight land.
    pub(super) fn run_interrupted(&mut self) {
        while self.core.state.pc() != THREAD_DONE {
            assert_eq!(self.core.step(&mut self.ram), Ok(()));
            if self.core.state.is_interruptible() {
                self.core.state.land_all();
            }
        }
    }
}

/// Memory with a program.
fn loaded(linked: &LinkedProgram) -> Ram {
    let mut ram = Ram::default();
    let (text, data) = (&linked.text, &linked.data);
    ram.set_bytes(text.address.get(), &text.bytes);
    ram.set_bytes(data.address.get(), &data.bytes);
    ram.code = text.address.get()..text.address.get() + text.bytes.len() as u32;
    ram
}

/// Runs `main` to its end; panics if the program does something forbidden.
pub(super) fn run(linked: &LinkedProgram) -> Run {
    let mut ram = loaded(linked);
    let mut core = Core::new(linked.entry.get());
    let mut firmware = firmware::Firmware::new(linked);
    scramble(&mut core, !0, 1);
    core.state.set_reg(c67x::Reg::b(15), STACK);
    core.state.set_reg(c67x::Reg::a(14), 1);
    core.state.set_reg(c67x::Reg::b(3), THREAD_DONE);
    let kept = KEPT.map(|reg| core.state.reg(reg));
    loop {
        core.state.clock.set_left(MOST_CYCLES - core.state.cycle().cast_signed());
        match core.run(&mut ram) {
            Halt::Left(THREAD_DONE) => break,
            Halt::Left(address) => {
                firmware.call(GuestAddr::new(address), &mut core, &mut ram);
                core.state.set_pc(core.state.reg(c67x::Reg::b(3)));
            }
            halt => panic!("{halt:?} at {:08x}", core.state.pc()),
        }
    }
    assert_eq!(core.state.reg(c67x::Reg::b(15)), STACK, "the stack pointer comes back");
    assert_eq!(KEPT.map(|reg| core.state.reg(reg)), kept, "kept registers come back");
    let result = core.state.reg(c67x::Reg::a(4)).cast_signed();
    Run { console: firmware.console, result, cycles: core.state.cycle() }
}

/// The callee-saved registers.
const KEPT: [c67x::Reg; 11] = [
    c67x::Reg::a(10),
    c67x::Reg::a(11),
    c67x::Reg::a(12),
    c67x::Reg::a(13),
    c67x::Reg::a(14),
    c67x::Reg::a(15),
    c67x::Reg::b(10),
    c67x::Reg::b(11),
    c67x::Reg::b(12),
    c67x::Reg::b(13),
    c67x::Reg::b(14),
];

/// Stores random values in the registers of a set, one bit for each.
pub(super) fn scramble(core: &mut Core, set: u64, seed: u32) {
    for index in (0..64).filter(|index| set >> index & 1 != 0) {
        if let Some(reg) = c67x::Reg::from_index(index) {
            core.state
                .set_reg(reg, seed.wrapping_mul(0x9E37_79B9) ^ (index as u32).wrapping_mul(0x0101_0777));
        }
    }
}
