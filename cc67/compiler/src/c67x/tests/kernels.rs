//! Kernels: the cycles of a call of each, compared with the vendor's compiler, hand-written code and the processor's
//! limit.
//!
//! The tables are a section of `cc67/benches/README.md`; `CC67_WRITE_BOOK=1` rewrites them.

use std::fmt::Write as _;

use super::{build, machine};
use crate::c67x::abi;
use crate::passes::Level;

/// The addresses of array arguments.
const FIRST: u32 = 0x8006_0000;
const SECOND: u32 = 0x8006_8000;
/// The address of a string, and its length with the terminator.
const STRING: u32 = 0x8006_F000;
const LENGTH: u32 = 40;

/// A call of a function.
struct Kernel {
    /// The function, and the name of its file in `vm/benches/processor`.
    name: &'static str,
    source: &'static str,
    /// A description of the computation.
    what: &'static str,
    arguments: &'static [u32],
    /// The cycles of the vendor's code and of hand-written code (`c67x.md` 7).
    vendor: Option<u64>,
    by_hand: Option<u64>,
    /// The minimum number of cycles by the processor's rules: the longest dependence chain of an iteration times the
    /// number of iterations.
    limit: u64,
}

macro_rules! kernel {
    ($name:literal, $what:literal, [$($argument:expr),*], $vendor:expr, $by_hand:expr, $limit:expr) => {
        Kernel {
            name: $name,
            source: include_str!(concat!("../../../../../vm/benches/processor/", $name, ".c")),
            what: $what,
            arguments: &[$($argument),*],
            vendor: $vendor,
            by_hand: $by_hand,
            limit: $limit,
        }
    };
}

const KERNELS: &[Kernel] = &[
    kernel!("sum", "sum of 1 integer", [FIRST, 1], Some(161), Some(13), 13),
    kernel!("sum", "of 12", [FIRST, 12], Some(1206), Some(79), 23),
    kernel!("sum", "of 96", [FIRST, 96], Some(9186), Some(583), 65),
    kernel!("sum12", "the same, 12 an iteration", [FIRST, 1], Some(1206), Some(23), 23),
    kernel!("sum12", "96, 12 an iteration", [FIRST, 8], Some(9186), Some(65), 65),
    kernel!("dot", "64 products of doubles, one sum", [FIRST, SECOND, 64], None, None, 6 * 64),
    kernel!("dot2", "2 products of doubles, two sums", [FIRST, SECOND, 2], Some(380), Some(36), 36),
    kernel!("dot2", "16", [FIRST, SECOND, 16], Some(2508), Some(78), 78),
    kernel!("dot2", "64", [FIRST, SECOND, 64], Some(9804), Some(222), 222),
    kernel!("sw", "switch, a case", [3], Some(54), Some(15), 15),
    kernel!("sw", "switch, the default", [9], Some(123), Some(15), 15),
    kernel!("copy", "copy of a string of 40 bytes", [SECOND, STRING], None, None, 11 * 40),
    kernel!("crc16", "CRC-16 of 16 bytes", [FIRST, 16], None, None, 16 * 16),
];

/// A program of `vm/benches/kernels`, with less work.
struct Whole {
    /// The file.
    name: &'static str,
    source: &'static str,
    /// A description of the computation.
    what: &'static str,
    /// Texts in the source, and their replacements.
    less: &'static [(&'static str, &'static str)],
    /// The cycles of the longest dependence chain, if it is known.
    limit: Option<u64>,
}

macro_rules! whole {
    ($name:literal, $what:literal, $limit:expr, [$($less:expr),*]) => {
        Whole {
            name: $name,
            source: include_str!(concat!("../../../../../vm/benches/kernels/", $name, ".c")),
            what: $what,
            less: &[$($less),*],
            limit: $limit,
        }
    };
}

/// The chains are: for a sample of the filter, 19 sums and products of floats; for a step of a sequence, three
/// instructions; for the next point, two products and a sum; for a term of a matrix product, the previous sum.
const WHOLE: &[Whole] = &[
    whole!("filter", "100 samples", Some(100 * 19 * 4), [("20000000", "100")]),
    whole!("integer", "sequences of 1 to 99, 3117 steps", Some(3117 * 3), [("1500000", "100")]),
    whole!(
        "mandelbrot",
        "144 points, 1940 steps",
        Some(1940 * 24),
        [("1200", "12"), ("400.0", "4.0"), ("n < 500", "n < 50")]
    ),
    whole!("matrix", "two products of 12 by 12", Some(2 * 12 * 12 * 12 * 6), [("120", "12"), ("400", "2")]),
    whole!("nbody", "20 steps of five bodies", None, [("4000000", "20")]),
    whole!("recursion", "Fibonacci of 15, Ackermann of 2 and 25", None, [("41", "15"), ("400", "1")]),
    whole!("sieve", "up to 3000", None, [("300000 - round", "3000"), ("800", "1")]),
    whole!("text", "100 words", None, [("1000000", "100")]),
    whole!("trajectory", "two moves", None, [("2500", "2"), ("0.00018", "0.018")]),
];

const LEVELS: [Level; 3] = [Level::Small, Level::Full, Level::Fast];

/// The cycles of a call, from the first packet of the function to the first one after its return.
fn cycles(kernel: &Kernel, level: Level) -> u64 {
    call(kernel, level).run()
}

/// A call, at the first packet of the function.
fn call(kernel: &Kernel, level: Level) -> machine::Call {
    let keep = format!("void *keep = (void *){};\nint main(void) {{ return keep != 0; }}\n", kernel.name);
    let linked = build(&(kernel.source.to_owned() + &keep), level);
    let mut call = machine::Call::new(&linked, kernel.name);
    for element in 0..200_u32 {
        call.ram.set_bytes(FIRST + 8 * element, &(1.0 + f64::from(element) / 4.0).to_le_bytes());
        call.ram.set_bytes(SECOND + 8 * element, &(f64::from(element) - 50.5).to_le_bytes());
    }
    call.ram.set_bytes(STRING, &[b'x'; LENGTH as usize - 1]);
    for (value, reg) in kernel.arguments.iter().zip(abi::ARGUMENTS) {
        call.core.state.set_reg(reg, *value);
    }
    call
}

/// The table, as Markdown.
fn table() -> String {
    let mut table = "| kernel | vendor | by hand | limit | `-Os` | `-O1` | `-O2` |\n|---|---:|---:|---:|---:|---:|---:|\n".to_owned();
    let known = |cycles: Option<u64>| cycles.map_or(String::new(), |cycles| cycles.to_string());
    for kernel in KERNELS {
        let [small, full, fast] = LEVELS.map(|level| cycles(kernel, level));
        let (vendor, by_hand) = (known(kernel.vendor), known(kernel.by_hand));
        // Writing to a string cannot fail.
        let _ = writeln!(
            table,
            "| `{}`: {} | {vendor} | {by_hand} | {} | {small} | {full} | {fast} |",
            kernel.name, kernel.what, kernel.limit
        );
    }
    table
}

/// The table of whole programs.
fn table_of_programs() -> String {
    let mut table = "| program | limit | `-Os` | `-O1` | `-O2` |\n|---|---:|---:|---:|---:|\n".to_owned();
    for Whole { name, source, what, less, limit } in WHOLE {
        let source = less.iter().fold((*source).to_owned(), |source, (from, to)| {
            assert!(source.contains(from), "{name} has {from}");
            source.replace(from, to)
        });
        let runs = LEVELS.map(|level| machine::run(&build(&source, level)));
        assert!(runs.iter().all(|run| run.console == runs[0].console), "{name}: {runs:?}");
        let [small, full, fast] = runs.map(|run| run.cycles);
        let limit = limit.map_or(String::new(), |cycles| cycles.to_string());
        // Writing to a string cannot fail.
        let _ = writeln!(table, "| `{name}`: {what} | {limit} | {small} | {full} | {fast} |");
    }
    table
}

/// The page with the table that begins with `head` replaced.
fn with_table(page: &str, head: &str, table: &str) -> String {
    let start = page.find(head).expect("the table");
    let end = start + page[start..].find("\n\n").expect("a text after the table") + 1;
    format!("{}{table}{}", &page[..start], &page[end..])
}

#[test]
fn the_benchmark_page_shows_the_measured_cycles() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../benches/README.md");
    let page = std::fs::read_to_string(path).expect("the page");
    let written = with_table(&page, "| kernel | vendor |", &table());
    let written = with_table(&written, "| program | limit |", &table_of_programs());
    if std::env::var_os("CC67_WRITE_BOOK").is_some() {
        std::fs::write(path, written).expect("the page can be written");
    } else {
        assert!(page == written, "CC67_WRITE_BOOK=1 rewrites it");
    }
}

/// The cycles of the worked examples, each at its best level. None takes more than 1.3 times the hand-written code.
const REACHED: &[(&str, u64)] = &[
    ("sum of 1 integer", 14),
    ("of 12", 55),
    ("of 96", 307),
    ("the same, 12 an iteration", 19),
    ("96, 12 an iteration", 74),
    ("2 products of doubles, two sums", 37),
    ("16", 98),
    ("64", 242),
    ("switch, a case", 19),
    ("switch, the default", 19),
];

#[test]
fn worked_examples_are_nearly_as_fast_as_handwritten_code() {
    let mut reached = Vec::new();
    for kernel in KERNELS {
        let Some(by_hand) = kernel.by_hand else { continue };
        let best = LEVELS.map(|level| cycles(kernel, level)).into_iter().min().unwrap_or(u64::MAX);
        assert!(best * 10 <= by_hand * 13, "{}: {best} cycles, {by_hand} by hand", kernel.what);
        reached.push((kernel.what, best));
    }
    let is_no_slower =
        reached.iter().zip(REACHED).all(|(now, before)| now.0 == before.0 && now.1 <= before.1);
    assert!(is_no_slower && reached.len() == REACHED.len(), "slower than it was: {reached:?}");
}

#[test]
fn an_interrupt_at_any_point_changes_no_result() {
    for kernel in KERNELS {
        for level in LEVELS {
            let (mut plain, mut interrupted) = (call(kernel, level), call(kernel, level));
            plain.run();
            interrupted.run_interrupted();
            let high = if kernel.name.starts_with("dot") { abi::RESULT.pair().high() } else { abi::RESULT };
            let result = |call: &machine::Call| [abi::RESULT, high].map(|reg| call.core.state.reg(reg));
            assert_eq!(result(&plain), result(&interrupted), "{} at {level:?}", kernel.what);
        }
    }
}
