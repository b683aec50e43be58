//! Whole functions: words, registers, charges, and their results on the machine.

use kmotiondef::AccessSize;
use kmotiondef::timing::Timing;
use kmotiondef::{Cycles, GuestAddr, ThreadId, Ticks};
use vm::bus::Bus;
use vm::firmware::{Caller, Firmware, Outcome, Signature, TickContext, Value};
use vm::interp::BytecodeEngine;
use vm::machine::{Config, Machine};
use vm::memory::GuestMemory;
use vm::text::disassemble;
use vm::trap::{Trap, TrapKind};
use vm::verify::verify_image;

use crate::diag::Sink;
use crate::driver::generate;
use crate::firmware::{FirmwareSymbol, FirmwareSymbols};
use crate::link::{self, LinkedProgram};
use crate::lower::testing;
use crate::passes::Level;

/// A firmware without functions.
#[derive(Debug, Default)]
struct Nothing {
    traps: Vec<String>,
}

impl FirmwareSymbols for Nothing {
    fn find(&self, _: &str) -> Option<FirmwareSymbol> {
        None
    }

    fn symbol_names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        Box::new(std::iter::empty())
    }
}

impl Bus for Nothing {
    fn read(&mut self, _: GuestAddr, _: AccessSize, _: Cycles) -> u32 {
        0
    }

    fn write(&mut self, _: GuestAddr, _: AccessSize, _: u32, _: Cycles) {}

    fn access_cycles(&self, _: GuestAddr) -> Cycles {
        Cycles::new(0)
    }
}

impl Firmware for Nothing {
    fn signature(&self, _: GuestAddr) -> Option<&Signature> {
        None
    }

    fn call(&mut self, addr: GuestAddr, _: &mut Caller<'_>) -> Result<Outcome<Value>, TrapKind> {
        Err(TrapKind::UnknownFirmwareFunction { addr })
    }

    fn tick(&mut self, _: &mut TickContext<'_>) {}

    fn trapped(&mut self, trap: &Trap, _: &mut TickContext<'_>) {
        self.traps.push(trap.kind.to_string());
    }

    fn quiet_ticks(&self, _: &GuestMemory) -> u64 {
        u64::MAX
    }
}

fn build(source: &str, level: Level) -> LinkedProgram {
    let (unit, sources) = testing::unit(source);
    let mut sink = Sink::new();
    let object = generate(&unit, &sources, level, Timing::Fast, &mut sink);
    assert!(!sink.has_errors(), "{:?}", sink.diagnostics());
    let thread = ThreadId::new(1).expect("a thread");
    let options = link::Options {
        thread,
        firmware: &Nothing::default(),
        gc: true,
        addresses: link::SectionAddresses::default(),
    };
    link::link(&[object], &options).expect("links")
}

/// Runs `main` at both levels; the bytes of the global `out` and the traps must be the same.
fn run(source: &str) -> (Vec<u8>, Vec<String>) {
    let runs = [Level::None, Level::Full].map(|level| {
        let linked = build(source, level);
        let program = verify_image(&linked.text.bytes, linked.text.address).expect("compiled code passes");
        let mut machine: Machine<Nothing, BytecodeEngine> =
            Machine::new(Nothing::default(), Config::default());
        let memory = machine.firmware_mut().1.memory;
        memory.poke_bytes(linked.text.address, &linked.text.bytes).expect("fits");
        memory.poke_bytes(linked.data.address, &linked.data.bytes).expect("fits");
        machine.load_program(linked.thread, program, linked.entry);
        machine.start(linked.thread).expect("loaded");
        machine.run_until(Ticks::new(1000));
        let out = linked.symbols.iter().find(|symbol| symbol.name == "out").expect("`out` is a global");
        let (firmware, context) = machine.firmware_mut();
        let bytes = context.memory.read_bytes(out.address, out.size).expect("mapped");
        (bytes.to_vec(), firmware.traps.clone())
    });
    let [unoptimised, optimised] = runs;
    assert_eq!(unoptimised, optimised, "{source}");
    optimised
}

/// Checks the values that a program leaves in `int out[]`.
fn check(source: &str, expected: &[i32]) {
    let source = format!("int out[{}];\n{source}", expected.len());
    let (bytes, traps) = run(&source);
    assert_eq!(traps, Vec::<String>::new(), "{source}");
    let words: Vec<i32> = bytes.as_chunks().0.iter().map(|word| i32::from_le_bytes(*word)).collect();
    assert_eq!(words, expected, "{source}");
}

/// Compares the words of a program that consists of one function.
fn check_words(source: &str, expected: &str) {
    let text = disassemble(&build(source, Level::Full).text.bytes);
    let words = text.lines().filter(|line| line.starts_with('@')).skip_while(|line| !line.contains("func"));
    let words: Vec<&str> = words.filter_map(|line| Some(line.split_once(": ")?.1)).collect();
    let expected: Vec<&str> = expected.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    assert_eq!(words, expected, "{text}");
}

#[test]
fn words_use_displacements_immediates_and_absolute_addresses() {
    check_words(
        "int g; main(int *p, int n) { p[3] = g + 5 + (n << 2); }",
        "
        func sig0, 3, 0
        types 0x00000000
        charge 8
        load_i32_at r2, 0x80050080
        add_i32_imm r2, r2, 5
        shl_i32_imm r1, r1, 2
        add_i32 r1, r2, r1
        store_i32 r1, r0, +12
        const_i32 r2, 0
        ret_i32 r2
        ",
    );
}

#[test]
fn a_loop_loads_constants_beforehand_and_takes_one_branch_per_iteration() {
    check_words(
        "double x; main() { int i; for (i = 0; i < 100; i++) x += 0.5; }",
        "
        func sig0, 5, 0
        types 0x000000c3
        charge 3
        const_f64 d0, pool[0]
        const_i32 r1, 100
        const_i32 r2, 0
        charge 8
        load_f64_at d3, 0x800500c0
        add_f64 d3, d3, d0
        store_f64_at d3, 0x800500c0
        add_i32_imm r2, r2, 1
        lt_i32_s r4, r2, r1
        br_if r4, @9
        charge 3
        const_i32 r4, 0
        ret_i32 r4
        ",
    );
}

#[test]
fn registers_are_shared_except_between_values_live_at_the_same_time() {
    // Values that are live across the end of a loop keep theirs; `a` is a parameter and `b` is set before the loop.
    check(
        "f(int a) { int b = a * 2, i, s = 0; for (i = 0; i < 3; i++) { int t = a + i; s += t * b; } return s + a; }
         main() { out[0] = f(5); }",
        &[185],
    );
    // A local that keeps its value between iterations although the loop's body is one block.
    check(
        "f(int n) { int k; do { if (n == 3) k = 7; n--; } while (n); return k; } main() { out[0] = f(3); }",
        &[7],
    );
}

#[test]
fn a_parameter_survives_a_loop_at_the_start_of_its_function() {
    check("f(int a, int n) { for (;;) { if (n-- == 0) return a; } } main() { out[0] = f(42, 3); }", &[42]);
}

#[test]
fn structures_are_passed_returned_and_copied() {
    check(
        "struct S { int a; double d; char c[5]; };
         struct S make(int a) { struct S s = { a, a * 0.5, \"abcd\" }; return s; }
         int sum(struct S s, struct S *p) { s.a++; p->a += 10; return s.a + s.c[3]; }
         main() { struct S x = make(3), y; y = x; out[0] = sum(x, &y); out[1] = x.a; out[2] = y.a; out[3] = y.d * 10; }",
        &[104, 3, 13, 15],
    );
}

#[test]
fn copies_too_large_for_one_instruction_are_split() {
    check(
        "struct B { int a[20000]; } x, y;
         main() { x.a[0] = 1; x.a[16381] = 2; x.a[16382] = 3; x.a[19999] = 4; y = x;
                  out[0] = y.a[0]; out[1] = y.a[16381]; out[2] = y.a[16382]; out[3] = y.a[19999]; }",
        &[1, 2, 3, 4],
    );
}

#[test]
fn functions_are_called_by_address() {
    check(
        "int inc(int a) { return a + 1; } int (*table[])(int) = { inc, 0 };
         int call(int (*f)(int), int a) { return f(a); }
         main() { out[0] = call(inc, 4); out[1] = table[0](9); out[2] = table[1] == 0; }",
        &[5, 10, 1],
    );
}

#[test]
fn variable_arguments_are_read_back() {
    check(
        "int sum(int n, ...) { va_list l; int s = 0; va_start(l, n);
           while (n--) { s += va_arg(l, int); s += va_arg(l, double) * 10; } return s; }
         main() { out[0] = sum(2, 1, 0.5, 2, 1.5f) + sum(0); }",
        &[23],
    );
}

#[test]
fn switches_jump_to_the_matching_case() {
    let cases = "switch (v) { case 1: case 2: return 1; case 3: v += 100; case 4: return v; case 900 ... 999: return 5;
                 case -2147483647 - 1: return 6; case 7: break; default: return 8; } return 9;";
    check(
        &format!(
            "f(int v) {{ {cases} }} main() {{ int i, v[] = {{ 1, 2, 3, 4, 899, 900, 999, 1000, 5, 7, 0x80000000 }};
             for (i = 0; i < 11; i++) out[i] = f(v[i]); }}"
        ),
        &[1, 1, 103, 4, 8, 5, 5, 8, 8, 9, 6],
    );
    check(
        "f(long long v) { switch (v) { case 1LL << 40: return 1; case -1: return 2; } return 3; }
           main() { out[0] = f(1LL << 40); out[1] = f(-1); out[2] = f(0xffffffff); }",
        &[1, 2, 3],
    );
}

#[test]
fn a_division_by_zero_traps() {
    let (_, traps) = run("int out; main() { int a = 1; out = 5; a % (a - 1); out = 6; }");
    assert_eq!(traps, ["integer division by zero"]);
    let (bytes, _) = run("int out; main() { int a = 1; out = 5; a % (a - 1); out = 6; }");
    assert_eq!(bytes, [5, 0, 0, 0]);
}

#[test]
fn line_numbers_are_those_of_the_statements() {
    let linked = build("int g;\nmain()\n{\n  g = 1;\n\n  while (g < 9)\n    g++;\n}\n", Level::None);
    let lines: Vec<u32> = linked.lines.iter().map(|line| line.place.line).collect();
    assert_eq!(lines, [2, 4, 6, 7, 6, 8]);
    assert_eq!(linked.lines[0].address, linked.symbols[0].address);
}

#[test]
fn a_stack_frame_too_large_for_the_machine_is_refused() {
    let (unit, sources) = testing::unit("int f(void) { char a[600000]; a[0] = 1; return a[0]; }");
    let mut sink = Sink::new();
    let _ = generate(&unit, &sources, Level::Full, Timing::Fast, &mut sink);
    let message = sink.diagnostics().first().map(|diagnostic| diagnostic.message.as_str());
    assert_eq!(message, Some("the local variables of `f` are too large"));
}
