//! The compilation times of the optimisation levels: -O2 tries functions in several ways, within a budget.

use std::fmt::Write as _;
use std::path::Path;
use std::time::{Duration, Instant};

use compiler::passes::Level;
use compiler::target::Target;
use compiler::{Options, pp};

/// The maximum factor between the times of -O2 and -O1.
const MOST: u32 = 5;
/// Attempts before the machine is not to blame any more.
const ATTEMPTS: usize = 20;
/// The number of programs of each kind, and of functions in a program.
const PROGRAMS: u32 = 5;
const FUNCTIONS: u32 = 12;

/// A program of filters: loops over samples with several sections each, as for vibrations and tool paths.
fn filters(seed: u32) -> String {
    let mut random = seed.wrapping_mul(2_654_435_761) | 1;
    let mut next = |below: u32| {
        random ^= random << 13;
        random ^= random >> 17;
        random ^= random << 5;
        random % below
    };
    let mut text = String::new();
    for number in 0..FUNCTIONS {
        let mut locals = String::new();
        let mut loops = String::new();
        for index in 0..=next(3) {
            loops += "    for (i = 0; i < n; i++) {\n        double v = x[i];\n";
            for section in 0..2 + next(9) {
                let (z, w, at) = (format!("z{index}_{section}"), format!("w{index}_{section}"), next(30));
                let line = match next(4) {
                    0 => format!("v = v * c[{at}] + x[i + {}] * c[{}];", 1 + at % 5, at + 1),
                    1 => format!("if (v > c[{at}]) v = c[{at}];"),
                    2 => format!("v += y[i] * {at}.5;"),
                    _ => {
                        let _ = writeln!(locals, "    double {z} = 0, {w} = 0;");
                        format!(
                            "{{ double t = v - c[{at}] * {z} - c[{}] * {w}; v = t + c[{}] * {z} + {w}; {w} = {z}; {z} = t; }}",
                            at + 1,
                            at + 2
                        )
                    }
                };
                let _ = writeln!(loops, "        {line}");
            }
            loops += "        y[i] = v;\n    }\n";
        }
        let _ = write!(
            text,
            "void f{number}(double *c, double *x, double *y, int n)\n{{\n    int i;\n{locals}{loops}}}\n"
        );
    }
    text + "int main(void) { return 0; }\n"
}

#[expect(clippy::disallowed_methods, reason = "the time that compilation takes is measured")]
fn time(source: &str, level: Level) -> Duration {
    let options = Options { level, target: Target::C67x, ..Options::default() };
    let start = Instant::now();
    let compilation = compiler::compile(Path::new("filters.c"), source.into(), &options, &pp::Disk);
    let time = start.elapsed();
    assert!(compilation.object.is_some(), "it compiles");
    time
}

#[test]
fn the_second_level_takes_at_most_five_times_the_first() {
    let programs: Vec<String> = (1..=PROGRAMS).map(filters).collect();
    let lines = programs.iter().map(|source| source.lines().count()).sum::<usize>();
    let most = Duration::from_secs(1) * u32::try_from(lines).expect("a few thousand") / 1000;
    let all = |level| programs.iter().map(|source| time(source, level)).sum::<Duration>();
    let (mut first, mut second) = (Duration::MAX, Duration::MAX);
    // Other work on the machine only makes a time longer: the least ones count.
    for _ in 0..ATTEMPTS {
        first = first.min(all(Level::Full));
        second = second.min(all(Level::Fast));
        if second < first * MOST && second < most {
            println!("{lines} lines: -O1 takes {first:?}, -O2 {second:?}");
            return;
        }
    }
    panic!("{lines} lines: -O1 takes {first:?}, -O2 {second:?}");
}
