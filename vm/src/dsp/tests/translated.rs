//! Translated code, and loops with renamed registers, behave like the interpreter of single packets: registers, memory,
//! cycles, packets, faults.

use c67x::{PARALLEL, Reg, assemble};
use kmotiondef::GuestAddr;
use proptest::prelude::*;

use crate::dsp::{Clock, Core, Halt, Memory};
use crate::memory::GuestMemory;
use crate::trap::{Access, TrapKind};

const CODE: u32 = 0x8005_0000;
const BACK: u32 = 0x0000_1000;

/// Doubles of every kind, including those that the processor treats as zeros.
const DOUBLES: [f64; 20] = [
    1.5,
    -3.25,
    0.0,
    -0.0,
    4e-320,
    -4e-320,
    2.3e-308,
    -2.2250738585072014e-308,
    1e-160,
    -1e-200,
    1e300,
    f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    3e-271,
    -2.9e-271,
    7e9,
    1e-290,
    -1e-290,
];

/// The RAMs of the board, with code everywhere in SDRAM from [`CODE`] on.
#[derive(Clone, PartialEq)]
struct Ram(GuestMemory);

fn absent(addr: u32, access: Access) -> TrapKind {
    TrapKind::Unmapped { addr: GuestAddr::new(addr), access }
}

macro_rules! accesses {
    ($($load:ident, $store:ident, $ty:ty;)*) => {$(
        fn $load(&mut self, addr: u32, _: &mut Clock) -> Result<u32, TrapKind> {
            let value = self.0.load_ram::<$ty>(GuestAddr::new(addr));
            value.map(u32::from).ok_or_else(|| absent(addr, Access::Read))
        }

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

    fn load64(&mut self, addr: u32, _: &mut Clock) -> Result<u64, TrapKind> {
        self.0.load_ram(GuestAddr::new(addr)).ok_or_else(|| absent(addr, Access::Read))
    }
}

/// The words of assembled lines.
fn words(text: &str) -> Vec<u32> {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let mut words: Vec<u32> = Vec::new();
    for line in lines {
        let at = CODE + 4 * words.len() as u32;
        let line = assemble(line, at).unwrap_or_else(|error| panic!("{line}: {error}"));
        if line.joins_previous {
            *words.last_mut().expect("an instruction before") |= PARALLEL;
        }
        words.push(line.inst.encode(false));
    }
    words
}

/// The whole observable state of a core.
fn seen(core: &Core, halt: &Halt) -> String {
    let state = &core.state;
    let regs: Vec<u32> = (0..Reg::COUNT).filter_map(Reg::from_index).map(|reg| state.reg(reg)).collect();
    format!(
        "{halt:?} at {:x}, cycle {}, packets {}, branches {:x?}, interruptible {}, stack {:x?}, {regs:x?}",
        state.pc(),
        state.cycle(),
        core.packets(),
        state.branched_at(),
        state.is_interruptible(),
        core.lowest_stack(),
    )
}

/// The RAMs with these words, and a core at their beginning.
fn start(words: &[u32], regs: &[(Reg, u32)]) -> (Ram, Core) {
    let mut ram = Ram(GuestMemory::new());
    for (at, word) in (CODE..).step_by(4).zip(words) {
        ram.0.poke(GuestAddr::new(at), *word);
    }
    for at in 0..2048_u32 {
        ram.0.poke(GuestAddr::new(0x8006_0000 + 4 * at), at.wrapping_mul(0x9E37_79B9).rotate_left(at));
        ram.0.poke(GuestAddr::new(0x8007_0000 + 8 * at), DOUBLES[at as usize % DOUBLES.len()]);
    }
    let mut core = Core::new(CODE);
    core.state.set_reg(Reg::b(3), BACK);
    core.state.set_reg(Reg::b(15), 0x1001_3C78);
    core.watch_stack(0x1001_3400, 0x1001_3C78);
    regs.iter().for_each(|(reg, value)| core.state.set_reg(*reg, *value));
    (ram, core)
}

/// Runs words packet by packet and with loops, up to any packets, and compares the states there; returns the number of
/// packets that were executed in loops.
fn check_borders(words: &[u32], regs: &[(Reg, u32)], steps: &[u64]) -> u64 {
    let (mut ram, mut plain) = start(words, regs);
    let (mut others, mut looping) = (ram.clone(), plain.clone());
    plain.keep_to_packets();
    for step in steps.iter().cycle().take(200) {
        let until = plain.state.cycle() + step;
        let (one, two) = (plain.run_until(&mut ram, until), looping.run_until(&mut others, until));
        assert_eq!(seen(&plain, &one), seen(&looping, &two));
        assert_eq!(format!("{:?}", plain.state.picture()), format!("{:?}", looping.state.picture()));
        if one != Halt::Preempted {
            break;
        }
    }
    assert!(ram == others, "memory differs");
    looping.packets_in_loops()
}

/// Runs words packet by packet, with loops, and translated, in slices of this length; returns the number of translated
/// packets, or of packets in loops without translation.
fn check(words: &[u32], regs: &[(Reg, u32)], slice: i64, slices: usize) -> u64 {
    let (mut ram, mut plain) = start(words, regs);
    let (mut looping, mut translated) = (plain.clone(), plain.clone());
    plain.keep_to_packets();
    translated.translate(true);
    let mut rams = [ram.clone(), ram.clone()];
    for _ in 0..slices {
        plain.state.clock.set_left(slice);
        let halt = plain.run(&mut ram);
        let at_once = seen(&plain, &halt);
        plain.state.land_all();
        let landed = seen(&plain, &halt);
        for (other, others) in [&mut looping, &mut translated].into_iter().zip(&mut rams) {
            other.state.clock.set_left(slice);
            let end = other.run(others);
            assert_eq!(at_once, seen(other, &end));
            other.state.land_all();
            assert_eq!(landed, seen(other, &end), "landed");
        }
        if halt != Halt::Preempted {
            break;
        }
    }
    assert!(rams.iter().all(|others| ram == *others), "memory differs");
    if cfg!(feature = "native") { translated.translated() } else { looping.packets_in_loops() }
}

const INTEGER: [u32; 11] = [
    0x0013_E05B,
    0x0280_0029,
    0x0190_0058,
    0x030C_3665,
    0x2000_0191,
    0x2003_E05A,
    0x0000_6000,
    0x0298_A078,
    0x000C_0362,
    0x0214_0058,
    0x0000_6000,
];

/// `c67x.md` 7.3.
const DOUBLE: [u32; 30] = [
    0x0290_1059,
    0x0118_39A3,
    0x0480_0029,
    0x0210_88C2,
    0x0108_205B,
    0x0400_0029,
    0x0280_002B,
    0x0318_C4F8,
    0x0100_0029,
    0x0300_002B,
    0x0010_84FB,
    0x0018_C4F8,
    0x0180_0029,
    0x0380_002B,
    0x0410_84FA,
    0x0000_0000,
    0x0410_3765,
    0x0019_1701,
    0x6000_0010,
    0x0314_3766,
    0x0310_3765,
    0x0019_1702,
    0x0414_3767,
    0x0100_4318,
    0x010B_E05A,
    0x0200_831A,
    0x0000_A000,
    0x0210_5318,
    0x000C_0362,
    0x0000_8000,
];

#[test]
fn an_integer_loop_is_translated() {
    let translated = check(&INTEGER, &[(Reg::a(4), 0x8006_0000), (Reg::b(4), 20_000)], 18_000, 8);
    assert!(translated > 20_000, "{translated}");
}

#[test]
fn a_translated_loop_can_be_left_before_any_packet() {
    let regs = [(Reg::a(4), 0x8006_0000), (Reg::b(4), 20_000)];
    for step in 70..80 {
        let looped = check_borders(&INTEGER, &regs, &[step]);
        assert!(looped > 4_000, "{looped}");
    }
    // Software-pipelined: products of doubles, with results in flight to the same registers from two iterations.
    let regs = [(Reg::a(4), 0x8007_0000), (Reg::b(4), 0x8007_0008), (Reg::a(6), 1000)];
    for step in 70..80 {
        let looped = check_borders(&DOUBLE, &regs, &[step, 2 * step]);
        assert!(looped > 1_000, "{looped}");
    }
}

#[test]
fn a_fault_in_a_loop_keeps_the_results_in_flight() {
    // Products and one load land after the other load has run beyond SDRAM.
    let text = "MPYI .M1 A8,A9,A12\nMPYI .M2 B8,B9,B12\n|| LDW .D2T2 *B5++[1],B8\n|| ADDK .S2 1,B9\n|| LDW .D1T1 *A5++[16],A8\n\
                || B .S1 BACK\nADD .L1 A8,A9,A9\nNOP 5\n"
        .replace("BACK", &format!("0x{CODE:08X}"));
    let regs = [
        (Reg::a(5), 0x8100_0000 - 2000 * 64),
        (Reg::b(5), 0x8006_0000),
        (Reg::a(8), 3),
        (Reg::a(9), 5),
        (Reg::b(8), 7),
    ];
    check(&words(&text), &regs, 18_000, 10);
    assert!(check_borders(&words(&text), &regs, &[5000]) > 1000);
}

#[test]
fn repeatedly_overwritten_code_runs_the_same() {
    // Each iteration replaces the MVK after it by one of two constants.
    let text = "ADDK .S2 -1,B0\nXOR .L1 A6,A7,A6\nSTW .D1T1 A6,*A5\nNOP 5\nMVK .S1 1,A8\nADD .L1 A8,A9,A9\n\
                [B0] B .S2 B31\nNOP 5\nB .S2 B3\nNOP 5\n";
    let words = words(text);
    let two = assemble("MVK .S1 2,A8", CODE).expect("an instruction").inst.encode(false);
    let regs = [
        (Reg::b(0), 3000),
        (Reg::b(31), CODE),
        (Reg::a(5), CODE + 4 * 4),
        (Reg::a(6), words[4]),
        (Reg::a(7), words[4] ^ two),
    ];
    check(&words, &regs, 5_000, 40);
}

#[test]
fn an_access_outside_ram_ends_the_same() {
    // A pointer runs beyond the end of SDRAM.
    let text = "LDW .D1T1 *A5++[16],A8\nNOP 4\nADD .L1 A8,A9,A9\nB .S2 B31\nNOP 5\n";
    let translated =
        check(&words(text), &[(Reg::b(31), CODE), (Reg::a(5), 0x8100_0000 - 2000 * 64)], 18_000, 10);
    assert!(translated > 0);
}

/// A line of a loop, determined by a few numbers.
fn line(kind: u8, a: u8, b: u8, c: u8) -> String {
    // A4 to A7 and B4 to B7 are addresses, A0, A1, B1 and B2 conditions, B0 is a counter; the rest are values.
    let [x, y, d] = [a, b, c].map(|n| if n % 16 == 7 { 24 } else { 8 + n % 16 });
    let (p, q) = (4 + a % 4, 4 + b % 4);
    let pair = |n: u8| format!("A{}:A{}", 9 + n % 8 * 2, 8 + n % 8 * 2);
    let (one, two, three) = (pair(a), pair(b), pair(c));
    let condition = ["", "", "[A1] ", "[!A1] ", "[B1] ", "[!B2] "][usize::from(a.wrapping_add(c)) % 6];
    let text = match kind % 44 {
        0 => format!("ADD .L1 A{x},A{y},A{d}"),
        1 => format!("SUB .L2 B{x},B{y},B{d}"),
        2 => format!("AND .S1 A{x},A{y},A{d}"),
        3 => format!("XOR .S2 B{x},B{y},B{d}"),
        4 => format!("SHL .S1 A{x},A{y},A{d}"),
        5 => format!("SHR .S2 B{x},{},B{d}", b % 32),
        6 => format!("SHRU .S1 A{x},A{y},A{d}"),
        7 => format!("EXT .S2 B{x},{},{},B{d}", b % 32, c % 32),
        8 => format!("EXTU .S1 A{x},A{y},A{d}"),
        9 => format!("CLR .S2 B{x},{},{},B{d}", b % 32, c % 32),
        10 => format!("SET .S1 A{x},A{y},A{d}"),
        11 => format!("CMPGT .L1 A{x},A{y},A1"),
        12 => format!("CMPLTU .L2 B{x},B{y},B1"),
        13 => format!("CMPEQ .L2 B{x},B{y},B2"),
        14 => format!("SADD .L1 A{x},A{y},A{d}"),
        15 => format!("SSUB .L2 B{x},B{y},B{d}"),
        16 => format!("SUBC .L1 A{x},A{y},A{d}"),
        17 => format!("LMBD .L1 A{x},A{y},A{d}"),
        18 => format!("NORM .L2 B{x},B{d}"),
        19 => format!("ABS .L1 A{x},A{d}"),
        20 => format!("ADD2 .S1 A{x},A{y},A{d}"),
        21 => format!("MPY .M1 A{x},A{y},A{d}"),
        22 => format!("MPYHU .M2 B{x},B{y},B{d}"),
        23 => format!("SMPY .M1 A{x},A{y},A{d}"),
        24 => format!("MPYI .M1 A{x},A{y},A{d}"),
        25 => format!("MPYSP .M2 B{x},B{y},B{d}"),
        26 => format!("ADDSP .L2 B{x},B{y},B{d}"),
        27 => format!("SUBSP .L1 A{x},A{y},A{d}"),
        28 => format!("INTSP .L1 A{x},A{d}"),
        29 => format!("SPTRUNC .L2 B{x},B{d}"),
        30 => format!("INTDP .L1 A{x},{three}"),
        31 => format!("DPTRUNC .L1 {one},A{d}"),
        32 => format!("ADDDP .L1 {one},{two},{three}"),
        33 => format!("MPYDP .M1 {one},{two},{three}"),
        34 => format!("CMPLTDP .S1 {one},{two},A1"),
        35 => format!("LDW .D1T1 *A{p}[{}],A{d}", c % 32),
        36 => format!("LDH .D2T2 *B{q}[{}],B{d}", c % 32),
        37 => format!("LDDW .D1T1 *A{p}[{}],{three}", c % 16),
        38 => format!("STW .D2T2 B{x},*B{q}[{}]", c % 32),
        39 => format!("STB .D1T1 A{x},*A{p}[{}]", c % 32),
        40 => format!("MV .L1X B{x},A{d}"),
        41 => format!("ADDAW .D1 A{x},A{y},A{d}"),
        42 => format!("MVK .S1 {},A{d}", i32::from(a) * 200 - 20_000),
        _ => format!("SPDP .S2 B{x},B{}:B{}", 17 + c % 4 * 2, 16 + c % 4 * 2),
    };
    format!("{condition}{text}")
}

#[test]
fn doubles_of_every_kind_give_the_same_results() {
    let text = "ADDK .S2 -1,B0\nLDDW .D1T1 *A5++[1],A9:A8\nLDDW .D1T1 *A6[0],A11:A10\nNOP 4\n\
                MPYDP .M1 A9:A8,A11:A10,A13:A12\nADDDP .L1 A9:A8,A11:A10,A17:A16\nSUBDP .L1 A9:A8,A11:A10,A19:A18\nNOP 9\n\
                XOR .L1 A12,A20,A20\nXOR .L1 A13,A21,A21\nXOR .L1 A16,A22,A22\nXOR .L1 A17,A23,A23\n\
                XOR .L1 A18,A24,A24\nXOR .L1 A19,A25,A25\nROTL\n[B0] B .S2 B31\nNOP 5\nB .S2 B3\nNOP 5\n"
        .replace("ROTL\n", "SHL .S1 A20,1,A26\nADD .L1 A26,A21,A20\nADD .L1 A22,A21,A21\nADD .L1 A24,A22,A22\n")
        .replace(".S2 B31", &format!(".S1 0x{CODE:08X}"));
    for second in 0..DOUBLES.len() as u32 {
        let regs = [
            (Reg::b(0), 1900),
            (Reg::b(31), CODE),
            (Reg::a(5), 0x8007_0000),
            (Reg::a(6), 0x8007_0000 + 8 * second),
        ];
        assert!(check(&words(&text), &regs, 18_000, 8) > 10_000);
    }
}

/// Lines that write words which sums and products of doubles read in the cycles after their issue.
const BESIDE_DOUBLES: [u8; 12] = [0, 21, 30, 32, 32, 33, 33, 33, 34, 37, 40, 42];

/// A line of a loop, without a condition if its result comes later than in the first stage.
fn steady_line(kind: u8, a: u8, b: u8, c: u8) -> String {
    let text = line(kind, a, b, c);
    match text.split_once("] ") {
        Some((_, bare)) if kind % 44 > 20 => bare.to_owned(),
        _ => text,
    }
}

/// A loop of lines from numbers; every sixth is in parallel with the previous one, and every second is followed by a
/// gap.
fn random_loop(lines: &[([u8; 4], u8)], gap: u8, line: impl Fn(u8, u8, u8, u8) -> String) -> String {
    let mut text = String::from("ADDK .S2 -1,B0\n");
    for (index, ([kind, a, b, c], nop)) in lines.iter().enumerate() {
        if index > 0 && *nop == 5 {
            text += "|| ";
        }
        text += &line(*kind, *a, *b, *c);
        text.push('\n');
        if *nop < 3 {
            text += &format!("NOP {}\n", 1 + nop);
        }
    }
    text += "NOP 9\n";
    let back = if gap == 7 { "B .S2 B31" } else { "B .S1 0x80050000" };
    text + &format!("[B0] {back}\nNOP {gap}\nADD .L1 A8,A9,A10\nNOP 5\nB .S2 B3\nNOP 5\n")
}

/// Runs it with these numbers in the registers.
fn check_loop(text: &str, seeds: [u32; 32], slice: i64) {
    let mut regs =
        vec![(Reg::b(0), 3000), (Reg::b(31), CODE), (Reg::a(1), 1), (Reg::b(1), 0), (Reg::b(2), 1)];
    for (number, base) in (4..8).zip([0x8006_0000, 0x8006_0400, 0x8007_0000, 0x1001_0000]) {
        regs.extend([(Reg::a(number), base), (Reg::b(number), base + 0x100)]);
    }
    for (number, seed) in (8..24).zip(&seeds) {
        regs.extend([(Reg::a(number), *seed), (Reg::b(number), seed.rotate_left(9))]);
    }
    check(&words(text), &regs, slice, 60);
    check_borders(&words(text), &regs, &[slice.unsigned_abs() / 7, 167, 391]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_loops_run_the_same(
        lines in prop::collection::vec((any::<[u8; 4]>(), 0_u8..6), 4..24),
        gap in 1_u8..8,
        seeds in any::<[u32; 32]>(),
        slice in 900_i64..20_000,
    ) {
        check_loop(&random_loop(&lines, gap, line), seeds, slice);
    }

    #[test]
    fn random_loops_without_conditional_late_results_run_the_same(
        lines in prop::collection::vec((any::<[u8; 4]>(), 0_u8..6), 4..16),
        gap in 1_u8..8,
        seeds in any::<[u32; 32]>(),
        slice in 900_i64..20_000,
    ) {
        check_loop(&random_loop(&lines, gap, steady_line), seeds, slice);
    }

    #[test]
    fn doubles_whose_words_change_after_issue_run_the_same(
        lines in prop::collection::vec((any::<[u8; 4]>(), 3_u8..6), 4..24),
        gap in 1_u8..8,
        seeds in any::<[u32; 32]>(),
        slice in 900_i64..20_000,
    ) {
        let near = lines.iter().map(|([kind, a, b, c], nop)| {
            ([BESIDE_DOUBLES[usize::from(*kind) % BESIDE_DOUBLES.len()], *a, *b, *c], *nop)
        });
        check_loop(&random_loop(&near.collect::<Vec<_>>(), gap, line), seeds, slice);
    }
}
