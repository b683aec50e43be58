//! Charges for the statements of `data/vectors/costs.jsonl`, compared with the times of the vendor's code on the board.
//!
//! Every row is compared for memory without wait states, with those of the bus, and with 20 cycles for SDRAM. The cost
//! of a statement is the difference between a program with it and one without it, as the profiling engine counts.

use std::fs;

use cc67_host::{Setup, UserProgram};
use compiler::passes::Level;
use harness::Scratch;
use kmotiondef::timing::{Timing, WaitStates};
use kmotiondef::{ThreadId, Ticks};
use serde_json::Value as Json;
use vm::profile::ProfilingEngine;

/// The relative tolerance for a statement.
const LIMIT: f64 = 0.1;

/// A number of cycles smaller than the cost of one access.
const SLIGHT: f64 = 2.0;

/// Statements with larger deviations, each with the reason.
const OTHERS: &[(&str, &str)] = &[
    ("li=*lp", TO_THE_STACK),
    ("*lp=li", TO_THE_STACK),
    ("li=lp[lj]", TO_THE_STACK),
    ("vi=ReadBit(3)", BUS),
    ("SetBit(3)", BUS),
    ("x=Time_sec()", BUS),
    ("sprintf(buf,\"a\")", STRINGS),
    ("sprintf(buf,\"%d\",lj)", STRINGS),
    ("sprintf(buf,\"%d %d %d\",lj,lj,lk)", STRINGS),
    ("gd=sin(gd)", "the cost of a sine is that of usual arguments"),
    ("gst2=gst", "the cost of a copy follows a formula that is 16 cycles off for this size"),
    (
        "gda[lj]=gda[lj]+gda[lk]*ld",
        "an element of a double that is assigned to one: known to be 20 cycles more",
    ),
    ("li=(lj+lk)*((lj-lk)+((lj&lk)|(lj^lk)))", "the second value that is put aside costs 10 more"),
];

const TO_THE_STACK: &str =
    "what a pointer leads to is taken to be in SDRAM, which waits; this one leads to the stack";
const BUS: &str =
    "a call is charged with the wait states of the bus as the firmware programs it, at every setting";
const STRINGS: &str = "a call is charged without waits for strings in SDRAM";

/// The variables of the statements: `l…` local, `g…` global.
const GLOBALS: &str = "#include \"KMotionDef.h\"
typedef struct { int a; double d; int b[4]; int e; } ST; ST gst, gst2, *gsp = &gst;
int gi = 5, gj = 7, ga[10], *gp = ga; unsigned gu; char gc, gca[10], buf[200]; short gs; double gd = 1, ge = 2;
double gda[10], *gdp = gda; float gf = 1, gg = 2; float gfa[10]; volatile int vi; double x;
void f0() {} void f1(int a) {} void f2(int a, int b) {} void f3(int a, int b, int c) {}
void f4(int a, int b, int c, int d) {} void f6(int a, int b, int c, int d, int e, int f) {}
void l4() {} int r0() { return 1; } int r1(int a) { return a; } double d1(double a) { return a; }
void d2(double a, double b) {} float ff1(float a) { return a; } void (*fp)() = f0;
";
const LOCALS: &str = "
int li, lj, lk, la[10], *lp; unsigned lu; char lc; double ld, le; float lf, lg;
li = 5; lj = 7; lk = 3; lu = 9; lc = 1; ld = 1.0; le = 2.0; lf = 1.0f; lg = 2.0f; lp = la;
";

fn rows() -> Vec<Json> {
    let text =
        fs::read_to_string(harness::root().join("tests/data/vectors/costs.jsonl")).expect("it is there");
    let lines = text.lines().map(|line| serde_json::from_str::<Json>(line).expect("JSON"));
    lines.filter(|line| line["kind"] == "construct").collect()
}

/// The cycles of `main` with a statement.
fn spent(scratch: &Scratch, statement: &str, waits: WaitStates) -> f64 {
    scratch.write("work.c", format!("{GLOBALS}main()\n{{\n{LOCALS}{statement};\n}}\n"));
    let mut setup = Setup::default();
    setup.options.timing = Timing::Vendor(waits);
    setup.options.level = Level::None;
    let thread = ThreadId::new(1).expect("a thread");
    let program = UserProgram::compile(&scratch.path().join("work.c"), thread, &setup.options);
    setup.programs.push(program.unwrap_or_else(|error| panic!("{statement}: {error}")).started());
    let mut session = setup.session_on(ProfilingEngine::default()).expect("it fits");
    let _ = session.run(Ticks::new(1000), &mut |_| ());
    assert!(session.has_ended(), "{statement}");
    session.target().machine().engine().profile().sites().map(|(_, spent)| spent.computing.get() as f64).sum()
}

#[test]
fn every_statement_is_charged_what_it_takes_on_the_board() {
    let scratch = Scratch::new("cost-statements");
    let settings = [WaitStates::NONE, WaitStates::REGISTERS, WaitStates { register: 44, sdram: 20 }];
    let rows = rows();
    assert_eq!(rows.len(), 234);
    let (mut exact, mut all) = (0, Vec::new());
    for (setting, waits) in settings.into_iter().enumerate() {
        let empty = spent(&scratch, "", waits);
        for row in &rows {
            let statement = row["c"].as_str().expect("a statement");
            let recorded = row["cycles"][setting].as_f64().expect("cycles");
            let found = spent(&scratch, statement, waits) - empty;
            exact += i32::from((found - recorded).abs() < 0.5);
            let error = (found - recorded).abs() / recorded;
            let text = format!("{statement} ({setting}): {found}, recorded {recorded}");
            all.push((error, (found - recorded).abs(), text, statement));
        }
    }
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    eprintln!("{exact} of {} exactly; the worst:", all.len());
    all.iter().take(10).for_each(|(error, _, text, _)| eprintln!("{text} ({:.1} %)", 100.0 * error));
    let off: Vec<_> = all.iter().filter(|(error, cycles, ..)| *error > LIMIT && *cycles > SLIGHT).collect();
    let is_named = |statement: &str| OTHERS.iter().any(|(known, _)| *known == statement);
    let report: Vec<_> = off.iter().filter(|row| !is_named(row.3)).map(|row| row.2.as_str()).collect();
    assert!(report.is_empty(), "{} of {}:\n{}", report.len(), all.len(), report.join("\n"));
    for (statement, reason) in OTHERS {
        assert!(off.iter().any(|row| row.3 == *statement), "{statement} is right: {reason}");
    }
}
