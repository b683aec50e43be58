//! The speed of the interpreter of the DSP: millions of cycles and packets per second of the host's CPU time.
//!
//! `kernel/integer`, `kernel/memory` and `kernel/double` are the hand-written loops of `c67x.md` 7; those named `cc67`
//! are the compiler's output for the same loops; `translated` runs them as host code. Goals: 150 million cycles per
//! second interpreted, 600 translated. If `CC67_FIRMWARE` names a firmware file, `boot` is its start (goal: 0.3 s),
//! `idle` a second of board time after it, `eight axes` a second in which all axes move, and `seven threads` a second
//! in which seven threads wait as well (goal: 1 s each).
//!
//! ```sh
//! CC67_FIRMWARE=DSPKFLOP.out cargo bench -p cc67-boot --features native
//! cargo bench -p cc67-boot --features native -- double       # those with this in their names
//! ```

use std::sync::Arc;
use std::time::Duration;

use boot::{BootedBoard, FirmwareFile};
use kmotiondef::{GuestAddr, ThreadId};
use vm::dsp::{Clock, Core, Halt, Memory};
use vm::memory::GuestMemory;
use vm::trap::{Access, TrapKind};

/// The address of the kernels, and their return address.
const CODE: u32 = 0x8005_0000;
const BACK: u32 = 0x0000_1000;
/// The number of cycles of a measurement.
const CYCLES: u64 = 100_000_000;

/// `c67x.md` 7.1: one element in six cycles.
const INTEGER: &str =
    "0013E05B 02800029 01900058 030C3665 20000191 2003E05A 00006000 0298A078 000C0362 02140058 00006000";
/// `c67x.md` 7.3: products of doubles, three cycles per element.
const DOUBLE: &str = "02901059 011839A3 04800029 021088C2 0108205B 04000029 0280002B 0318C4F8 01000029 0300002B 001084FB \
                      0018C4F8 01800029 0380002B 041084FA 00000000 04103765 00191701 60000010 03143766 03103765 00191702 \
                      04143767 01004318 010BE05A 0200831A 0000A000 02105318 000C0362 00008000";
/// Copies words, one in six cycles, with load and store in parallel.
const COPY: &str =
    "0013E05B 02800029 01900058 030C3665 20000191 2003E05A 00006000 030C0274 000C0362 02140058 00006000";

/// The code that cc67 generates for `for (i = 0; i < n; i++) s = (s << 1) + (a[i] ^ i);` at `-O1`.
const OWN_INTEGER: &str = "00100ADB 01800029 0280002A 30000912 00008000 02900941 00000001 00000000 03140267 030C2CA1 02948058 00006000 \
     0398ADFB 029421A2 0090AAFB 019CD078 4FFFFC12 00008000 020C0941 000C0362 00008000";
/// The code for `for (i = 0; i < n; i++) to[i] = from[i];`.
const OWN_COPY: &str = "00180AD9 01800028 D0000792 00008000 02900942 028C4CA1 018C2058 0390A078 00986AF9 031C0266 8FFFFE92 00004000 \
     031402F7 0294805A 00000000 000C0362 00008000";
/// The code for `for (i = 0; i < n; i++) s += a[i] * b[i];`, with doubles.
const OWN_DOUBLE: &str = "00180AD9 04000029 0280002A 04800029 D0000A92 00008000 01900941 00000000 03146CA3 020C0365 0294205B 018D0058 \
     0390C07B 0114D8F8 001C03E4 00006000 02008700 0000E000 04110318 AFFFFC12 00008000 02200941 02A40059 000C0362 \
     00008000";

/// Only the two RAMs.
struct Ram(GuestMemory);

fn absent(addr: u32, access: Access) -> TrapKind {
    TrapKind::Unmapped { addr: GuestAddr::new(addr), access }
}

macro_rules! accesses {
    ($($load:ident, $store:ident, $ty:ty;)*) => {$(
        #[inline(always)]
        fn $load(&mut self, addr: u32, _: &mut Clock) -> Result<u32, TrapKind> {
            let value = self.0.load_ram::<$ty>(GuestAddr::new(addr));
            value.map(u32::from).ok_or_else(|| absent(addr, Access::Read))
        }

        #[inline(always)]
        fn $store(&mut self, addr: u32, value: u32, _: &mut Clock) -> Result<(), TrapKind> {
            let stored = self.0.store_ram(GuestAddr::new(addr), value as $ty);
            stored.ok_or_else(|| absent(addr, Access::Write))
        }
    )*};
}

impl Memory for Ram {
    #[cfg(feature = "native")]
    fn ram(&mut self) -> Option<&mut GuestMemory> {
        Some(&mut self.0)
    }

    fn fetch(&self, addr: u32) -> Option<u32> {
        (addr >= CODE).then(|| self.0.peek(GuestAddr::new(addr)))
    }

    accesses! { load8, store8, u8; load16, store16, u16; load32, store32, u32; }

    #[inline(always)]
    fn load64(&mut self, addr: u32, _: &mut Clock) -> Result<u64, TrapKind> {
        self.0.load_ram(GuestAddr::new(addr)).ok_or_else(|| absent(addr, Access::Read))
    }
}

/// The processor time since the start of the process.
fn cpu() -> Duration {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Duration::new(time.tv_sec.try_into().unwrap_or(0), time.tv_nsec.try_into().unwrap_or(0))
    }
    #[cfg(not(unix))]
    Duration::ZERO
}

/// Shows the result of a measurement.
fn show(name: &str, began: Duration, cycles: u64, packets: u64) {
    let seconds = (cpu() - began).as_secs_f64();
    let rate = |count: u64| count as f64 / seconds / 1e6;
    println!("{name:26} {seconds:7.3} s {:8.1} M cycles/s {:8.1} M packets/s", rate(cycles), rate(packets));
}

fn kernel(name: &str, words: &str, arguments: &[(c67x::Reg, u32)]) {
    if std::env::args().skip(1).any(|argument| !argument.starts_with('-') && !name.contains(&argument)) {
        return;
    }
    let mut ram = Ram(GuestMemory::new());
    for (at, word) in (CODE..).step_by(4).zip(words.split_whitespace()) {
        ram.0.poke(GuestAddr::new(at), u32::from_str_radix(word, 16).expect("a word"));
    }
    for element in 0..4096_u32 {
        ram.0.poke(GuestAddr::new(0x8006_0000 + 8 * element), 1.0 + f64::from(element) / 64.0);
        ram.0.poke(GuestAddr::new(0x8007_0000 + 8 * element), f64::from(element % 100) - 50.5);
    }
    let mut core = Core::new(CODE);
    core.translate(name.ends_with("translated"));
    let began = cpu();
    let mut calls = 0;
    while core.state.cycle() < CYCLES {
        core.state.set_pc(CODE);
        core.state.set_reg(c67x::Reg::b(3), BACK);
        arguments.iter().for_each(|(reg, value)| core.state.set_reg(*reg, *value));
        assert_eq!(core.run_until(&mut ram, u64::MAX / 4), Halt::Left(BACK), "{name}");
        calls += 1;
    }
    assert!(calls > 10, "{name} is short");
    show(name, began, core.state.cycle(), core.packets());
}

/// Starts seven threads that repeatedly wait for their next slice.
fn start_waiting(board: &mut BootedBoard) {
    let wait = board.file().address("WaitNextTimeSlice").expect("it has the function").get();
    for thread in ThreadId::all() {
        let start = CODE + 0x1_0000 * (u32::from(thread.get()) - 1);
        let constant = |value: u32, reg: &str| {
            format!("MVK .S2 {},{reg}\nMVKH .S2 0x{value:08X},{reg}\n", i32::from(value as u16 as i16))
        };
        // Eight words up to the return address: two constants, the branch and its delay slots.
        let text = constant(wait, "B5") + &constant(start + 32, "B3") + "B .S2 B5\nNOP 5\nNOP 1\nNOP 1\n";
        let text = text + &format!("B .S1 0x{start:08X}\nNOP 5\n");
        for (at, line) in (start..).step_by(4).zip(text.lines()) {
            let inst = c67x::assemble(line, at).expect("an instruction").inst;
            board.memory_mut().poke(GuestAddr::new(at), inst.encode(false));
        }
        board.send_line(format!("EntryPoint{thread} {start:X}").as_bytes());
        board.execute(thread);
    }
    board.run_to(board.cycle() + 20_000_000).expect("it runs");
}

fn main() {
    let (a, b) = (c67x::Reg::a, c67x::Reg::b);
    let (first, second) = (0x8006_0000, 0x8007_0000);
    for how in ["", " translated"] {
        kernel(&format!("kernel/integer{how}"), INTEGER, &[(a(4), first), (b(4), 1000)]);
        kernel(&format!("kernel/memory{how}"), COPY, &[(a(4), first), (b(4), 1000), (a(5), second)]);
        kernel(&format!("kernel/double{how}"), DOUBLE, &[(a(4), first), (b(4), second), (a(6), 1000)]);
        kernel(&format!("cc67/integer{how}"), OWN_INTEGER, &[(a(4), first), (b(4), 1000)]);
        kernel(&format!("cc67/memory{how}"), OWN_COPY, &[(a(4), first), (b(4), second), (a(6), 1000)]);
        kernel(&format!("cc67/double{how}"), OWN_DOUBLE, &[(a(4), first), (b(4), second), (a(6), 1000)]);
    }
    let Some(path) = std::env::var_os("CC67_FIRMWARE") else {
        println!("boot, idle: not measured, CC67_FIRMWARE names no firmware file");
        return;
    };
    let file = FirmwareFile::read(&std::fs::read(path).expect("a file")).expect("a firmware file");
    let began = cpu();
    let mut board = BootedBoard::booted(Arc::new(file)).expect("it starts");
    show("boot", began, board.cycle(), board.packets());
    let (began, cycles, packets) = (cpu(), board.cycle(), board.packets());
    board.run_to(cycles + 200_000_000).expect("it runs");
    show("idle", began, board.cycle() - cycles, board.packets() - packets);
    let axes = (0..8).map(|axis| format!("OutputMode{axis}=6;OutputChan0{axis}={axis};EnableAxis{axis}"));
    axes.for_each(|line| board.send_line(line.as_bytes()));
    (0..8).for_each(|axis| board.send_line(format!("Jog{axis}=1000").as_bytes()));
    let (began, cycles, packets) = (cpu(), board.cycle(), board.packets());
    board.run_to(cycles + 200_000_000).expect("it runs");
    show("eight axes", began, board.cycle() - cycles, board.packets() - packets);
    println!("steps of generator 3: {:.3}", board.steps(3).0);
    start_waiting(&mut board);
    let (began, cycles, packets) = (cpu(), board.cycle(), board.packets());
    board.run_to(cycles + 200_000_000).expect("it runs");
    show("eight axes, seven threads", began, board.cycle() - cycles, board.packets() - packets);
    let active = ThreadId::all().filter(|thread| board.is_active(*thread) == Some(true)).count();
    println!("threads that wait: {active}");
}
