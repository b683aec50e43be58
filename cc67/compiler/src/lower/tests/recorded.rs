//! The charges of constructs and programs, compared with the board's (`vectors/costs.jsonl`).

use std::path::Path;

use kmotiondef::AccessSize;
use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_at};
use kmotiondef::timing::{Timing, WaitStates};
use kmotiondef::{CodeAddr, Cycles, GuestAddr, ThreadId, Ticks};
use serde_json::Value as Json;
use vm::bus::Bus;
use vm::firmware::{Caller, Firmware, Outcome, Signature, TickContext, Value};
use vm::interp::BytecodeEngine;
use vm::machine::{Config, Machine};
use vm::memory::GuestMemory;
use vm::operand::Class;
use vm::trap::{Trap, TrapKind};
use vm::verify::verify_image;

use crate::diag::Sink;
use crate::driver::generate;
use crate::firmware::{BuiltIn, FirmwareKind, FirmwareSymbols};
use crate::ir::inst;
use crate::link;
use crate::lower::{cost_table, testing};
use crate::passes::Level;

/// A firmware whose functions take as long as the board's and do nothing; it adds up slices.
#[derive(Debug, Default)]
struct Stopwatch {
    signatures: Vec<Option<Signature>>,
    spent: i64,
    traps: Vec<String>,
}

impl Stopwatch {
    fn new() -> Self {
        let signature = |name: &str| match BuiltIn.find(name)?.kind {
            FirmwareKind::Function(signature) => {
                let signature = signature?;
                let class = |class| match class {
                    inst::Class::I32 => Class::I32,
                    inst::Class::I64 => Class::I64,
                    inst::Class::F32 => Class::F32,
                    inst::Class::F64 => Class::F64,
                };
                let params = signature.params.into_iter().map(class).collect();
                Some(Signature { params, result: signature.result.map(class) })
            }
            FirmwareKind::Variable => None,
        };
        let signatures = FIRMWARE_FUNCTIONS.iter().map(|function| signature(function.name)).collect();
        Self { signatures, ..Self::default() }
    }
}

impl Bus for Stopwatch {
    fn read(&mut self, _: GuestAddr, _: AccessSize, _: Cycles) -> u32 {
        0
    }

    fn write(&mut self, _: GuestAddr, _: AccessSize, _: u32, _: Cycles) {}

    fn access_cycles(&self, _: GuestAddr) -> Cycles {
        Cycles::new(44)
    }
}

impl Firmware for Stopwatch {
    fn signature(&self, address: GuestAddr) -> Option<&Signature> {
        self.signatures[function_at(address)?].as_ref()
    }

    fn call(&mut self, addr: GuestAddr, caller: &mut Caller<'_>) -> Result<Outcome<Value>, TrapKind> {
        let number = function_at(addr).ok_or(TrapKind::UnknownFirmwareFunction { addr })?;
        // In some recorded constructs the arguments are not typical.
        caller.spend(FIRMWARE_FUNCTIONS[number].cost);
        let result = self.signatures[number].as_ref().and_then(|signature| signature.result);
        Ok(Outcome::Done(match result {
            None => Value::Unit,
            Some(Class::I32) => Value::I32(0),
            Some(Class::I64) => Value::I64(0),
            Some(Class::F32) => Value::F32(1.0),
            Some(Class::F64) => Value::F64(1.0),
        }))
    }

    fn tick(&mut self, _: &mut TickContext<'_>) {}

    fn follows_slices(&self) -> bool {
        true
    }

    fn slice_ran(&mut self, _: ThreadId, start: Cycles, end: Cycles, _: Option<CodeAddr>) {
        self.spent += (end - start).get();
    }

    fn trapped(&mut self, trap: &Trap, _: &mut TickContext<'_>) {
        self.traps.push(trap.kind.to_string());
    }

    fn quiet_ticks(&self, _: &GuestMemory) -> u64 {
        u64::MAX
    }
}

/// The cycles of `main`, without its entry.
fn spent(source: &str, level: Level, waits: WaitStates) -> i64 {
    let (unit, sources) = testing::unit(source);
    let mut sink = Sink::new();
    let object = generate(&unit, &sources, level, Timing::Vendor(waits), &mut sink);
    assert!(!sink.has_errors(), "{:?}", sink.diagnostics());
    let thread = ThreadId::new(1).expect("a thread");
    let addresses = link::SectionAddresses::default();
    let options = link::Options { thread, firmware: &BuiltIn, gc: true, addresses };
    let linked = link::link(&[object], &options).expect("links");
    let program = verify_image(&linked.text.bytes, linked.text.address).expect("compiled code passes");
    let config = Config { servo: Some(Cycles::new(2446)), shortcuts: false, ..Config::default() };
    let mut machine: Machine<Stopwatch, BytecodeEngine> = Machine::new(Stopwatch::new(), config);
    let memory = machine.firmware_mut().1.memory;
    memory.poke_bytes(linked.text.address, &linked.text.bytes).expect("fits");
    memory.poke_bytes(linked.data.address, &linked.data.bytes).expect("fits");
    machine.load_program(linked.thread, program, linked.entry);
    machine.start(linked.thread).expect("loaded");
    machine.run_until(Ticks::new(60));
    assert!(machine.firmware().traps.is_empty(), "{:?}\n{source}", machine.firmware().traps);
    machine.firmware().spent - i64::from(cost_table::ENTRY)
}

fn rows(kind: &str) -> Vec<Json> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/vectors/costs.jsonl");
    let text = std::fs::read_to_string(path).expect("the vectors are there");
    let rows = text.lines().map(|line| serde_json::from_str::<Json>(line).expect("a line is an object"));
    rows.filter(|row| row["kind"] == kind).collect()
}

/// The variables of the recorded constructs: `l…` local, `g…` global.
const GLOBALS: &str = "
    typedef struct { int a; double d; int b[4]; int e; } ST; ST gst, gst2, *gsp = &gst;
    int gi = 5, gj = 7, ga[10], *gp = ga; unsigned gu; char gc, gca[10], buf[200]; short gs; double gd = 1, ge = 2;
    double gda[10], *gdp = gda; float gf = 1, gg = 2; float gfa[10]; volatile int vi; double x;
    void f0() {} void f1(int a) {} void f2(int a, int b) {} void f3(int a, int b, int c) {}
    void f4(int a, int b, int c, int d) {} void f6(int a, int b, int c, int d, int e, int f) {}
    void l4() {} int r0() { return 1; } int r1(int a) { return a; } double d1(double a) { return a; }
    void d2(double a, double b) {} float ff1(float a) { return a; } void (*fp)() = f0;
    double fast_fabs(double), sin(double), sqrt(double), Time_sec(); float sinf(float);
    int ReadBit(int); void SetBit(int), ClearBit(int); int CheckDone(int);
    int sprintf(char *, const char *, ...), printf(const char *, ...);
";
const LOCALS: &str = "
    int li, lj, lk, la[10], *lp; unsigned lu; char lc; double ld, le; float lf, lg;
    li = 5; lj = 7; lk = 3; lu = 9; lc = 1; ld = 1.0; le = 2.0; lf = 1.0f; lg = 2.0f; lp = la;
";

/// Reports whether a construct is not compared.
fn is_other(construct: &str) -> bool {
    // Firmware structures; functions whose cost depends on the arguments.
    ["persist", "ch0", "ch1", "chan", "ServoTick", "FPGA", "printf", "sin(gd)", "PI"]
        .iter()
        .any(|word| construct.contains(word))
}

#[test]
fn constructs_take_the_recorded_cycles() {
    let empty = spent(&format!("{GLOBALS} main() {{ {LOCALS} }}"), Level::None, WaitStates::NONE);
    let (mut exact, mut off) = (0, Vec::new());
    for row in rows("construct") {
        let Some(construct) = row["c"].as_str().filter(|construct| !is_other(construct)) else { continue };
        let Some(recorded) = row["cycles"][0].as_i64() else { continue };
        let source = format!("{GLOBALS} main() {{ {LOCALS} {construct}; }}");
        let [found, optimised] =
            [Level::None, Level::Full].map(|level| spent(&source, level, WaitStates::NONE) - empty);
        assert_eq!(found, optimised, "at both levels: {construct}");
        if found == recorded {
            exact += 1;
        } else {
            off.push(format!("{construct}: {found}, recorded {recorded}"));
        }
    }
    assert!(off.len() < 20 && exact > 150, "{exact} exact, {} not:\n{}", off.len(), off.join("\n"));
}

#[test]
fn programs_take_the_recorded_cycles() {
    const PROTOTYPES: &str =
        "extern struct { int UserData[200]; } persist; double sin(double), cos(double), sqrt(double),
        fast_fabs(double), Time_sec(); int ReadBit(int); void SetBit(int), ClearBit(int);";
    let (mut compared, mut off) = (0, Vec::new());
    for row in rows("program") {
        let text = row["c"].as_str().expect("it has a source");
        if text.contains("sprintf") || text.contains("WaitNext") {
            continue;
        }
        let source = format!("{PROTOTYPES} {text} main() {{ work(); }}");
        let settings = [WaitStates::NONE, WaitStates::REGISTERS, WaitStates { register: 44, sdram: 20 }];
        for (index, waits) in settings.into_iter().enumerate().step_by(2) {
            let recorded = row["work"][index].as_f64().expect("a number");
            let [found, optimised] = [Level::None, Level::Full].map(|level| spent(&source, level, waits));
            assert_eq!(found, optimised, "at both levels: {text}");
            // The functions' costs include waits for registers.
            let found =
                found as f64 - if text.contains("ReadBit") && index == 0 { 44.0 * calls(text) } else { 0.0 };
            let error = (found - recorded) / recorded;
            compared += 1;
            // Most are within 0.3 %; the cost of printing and of sines depends on values that are not computed here.
            if error.abs() > 0.05 {
                off.push(format!(
                    "{} {index}: {found}, recorded {recorded}: {:.1} %",
                    row["name"],
                    error * 100.0
                ));
            }
        }
    }
    assert!(off.is_empty() && compared > 50, "{compared} compared\n{}", off.join("\n"));
}

/// The number of calls in a program that access a register.
fn calls(text: &str) -> f64 {
    if text.contains("i<60") { 120.0 } else { 200.0 }
}
