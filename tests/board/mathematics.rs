//! Mathematical functions, compared exactly: the same program on the modelled board and on the released firmware.
//!
//! Needs a firmware file in `CC67_FIRMWARE`. [`FUNCTIONS`] contains the minimum number of arguments, of 10,000, for
//! which both give the same bits; a better function raises it.

use std::fmt::Write as _;

use cc67_host::target::{BootedFirmware, Target};
use cc67_host::{Session, Setup, UserProgram};
use kmotiondef::timing::Timing;
use kmotiondef::variables::GATHER_BUFFER;
use kmotiondef::{GuestAddr, ThreadId, Ticks};

/// The number of arguments for each function.
const ARGUMENTS: u32 = 10_000;
/// The longest run: 60 s of board time.
const LONGEST: Ticks = Ticks::new(666_667);

/// Random numbers between `2^first` and `2^(first + spread)`, where the spread is a power of two.
#[derive(Clone, Copy)]
struct Drawn {
    first: i32,
    spread: i32,
    has_sign: bool,
}

const fn drawn(first: i32, spread: i32, has_sign: bool) -> Drawn {
    Drawn { first, spread, has_sign }
}

const ANY: Drawn = drawn(-16, 32, true);
const POSITIVE: Drawn = drawn(-16, 32, false);
const ANGLE: Drawn = drawn(-4, 8, true);
const BELOW_ONE: Drawn = drawn(-8, 8, true);
const POWER: Drawn = drawn(-4, 8, true);
const BASE: Drawn = drawn(-4, 8, false);

/// A function call in C, its arguments, and the minimum number of equal results.
type Tried = (&'static str, Drawn, u32);

const FUNCTIONS: &[Tried] = &[
    ("sqrt(x)", POSITIVE, 10_000),
    ("sin(x)", ANGLE, 10_000),
    ("cos(x)", ANGLE, 10_000),
    ("tan(x)", ANGLE, 10_000),
    ("asin(x)", BELOW_ONE, 10_000),
    ("acos(x)", BELOW_ONE, 10_000),
    ("atan(x)", ANY, 10_000),
    ("atan2(x, y)", ANY, 10_000),
    ("exp(x)", ANGLE, 10_000),
    ("exp2(x)", ANGLE, 10_000),
    ("exp10(x)", ANGLE, 10_000),
    ("log(x)", POSITIVE, 9_998),
    ("log2(x)", POSITIVE, 9_999),
    ("log10(x)", POSITIVE, 9_997),
    ("pow(fast_fabs(x), y)", POWER, 10_000),
    ("_divd(x, y)", ANY, 10_000),
    ("x / y", ANY, 10_000),
    ("sqrtf(x)", POSITIVE, 10_000),
    ("sinf(x)", ANGLE, 10_000),
    ("cosf(x)", ANGLE, 10_000),
    ("tanf(x)", ANGLE, 10_000),
    ("asinf(x)", BELOW_ONE, 10_000),
    ("acosf(x)", BELOW_ONE, 10_000),
    ("atanf(x)", ANY, 10_000),
    ("atan2f(x, y)", ANY, 10_000),
    ("expf(x)", ANGLE, 10_000),
    ("exp2f(x)", ANGLE, 10_000),
    ("exp10f(x)", ANGLE, 10_000),
    ("logf(x)", POSITIVE, 9_990),
    ("log2f(x)", POSITIVE, 9_990),
    ("log10f(x)", POSITIVE, 9_990),
    ("powf(fast_fabsf(x), y)", BASE, 9_990),
    ("_divf(x, y)", ANY, 10_000),
];

/// Functions that multiply by the value that their caller has left in register A8, in which a fifth argument would be
/// passed.
///
/// Their first product is issued before the converted factor has reached the low register of the pair.
const WITH_A8: [&str; 3] = ["logf", "log2f", "log10f"];

/// A call in the program for a board: on the firmware with 0 in A8.
fn call_on(call: &str, is_firmware: bool) -> String {
    match call.split_once('(') {
        Some((name, _)) if is_firmware && WITH_A8.contains(&name) => {
            format!("((float (*)(float, int, int, int, int)){name})(x, 0, 0, 0, 0)")
        }
        _ => call.to_owned(),
    }
}

/// A program that stores the results of all functions in the gather buffer.
fn program(is_firmware: bool) -> String {
    let mut text = format!(
        "#include \"KMotionDef.h\"\n\
         double _divd(double, double); float _divf(float, float);\n\
         double exp2(double), exp10(double), log2(double); float exp2f(float), exp10f(float), log2f(float);\n\
         unsigned s;\n\
         unsigned next() {{ s = s * 1664525u + 1013904223u; return s; }}\n\
         double draw(unsigned first, unsigned mask, unsigned sign)\n{{\n\
         \x20   double x; unsigned *w = (unsigned *)&x; unsigned high = next() >> 12;\n\
         \x20   w[0] = next(); w[1] = high | (first + (next() >> 16 & mask)) << 20 | (next() & sign);\n\
         \x20   return x;\n}}\n\
         int main()\n{{\n    double *r = (double *)gather_buffer, x, y; int i;\n    s = 1;\n    persist.UserData[0] = 0;\n\
         \x20   for (i = 0; i < {}; i++) r[i] = 0;\n",
        ARGUMENTS as usize * FUNCTIONS.len()
    );
    for (call, Drawn { first, spread, has_sign }, _) in FUNCTIONS {
        let draw = format!("draw({}, {}, {}u)", 1023 + first, spread - 1, u32::from(*has_sign) << 31);
        let call = call_on(call, is_firmware);
        writeln!(text, "    for (i = 0; i < {ARGUMENTS}; i++) {{ x = {draw}; y = {draw}; *r++ = {call}; }}")
            .expect("a string");
    }
    text + "    persist.UserData[0] = 1;\n    return 0;\n}\n"
}

/// The results of the program on a board, as bits.
fn results<T: Target>(session: &mut Session<T>) -> Vec<u64> {
    while session.user_data(0) != Some(1) && session.tick() < LONGEST {
        session.step(LONGEST, &mut |_| {});
    }
    assert_eq!(session.user_data(0), Some(1), "the program has ended");
    let begin = GuestAddr::new(session.peek_object(GATHER_BUFFER.address()));
    let count = ARGUMENTS * FUNCTIONS.len() as u32;
    (0..count).map(|index| session.peek_object::<f64>(begin.offset(8 * index)).to_bits()).collect()
}

fn setup(firmware: Option<&BootedFirmware>) -> Setup {
    let mut setup = Setup::default();
    setup.options.timing = Timing::VENDOR;
    if let Some(firmware) = firmware {
        setup.options = firmware.options(setup.options);
    }
    let thread = ThreadId::new(1).expect("there is a first thread");
    let path = "mathematics.c".as_ref();
    let program = UserProgram::compile_text(path, program(firmware.is_some()).into(), thread, &setup.options);
    setup.programs.push(program.unwrap_or_else(|error| panic!("{error}")).started());
    setup
}

#[test]
fn functions_of_mathematics_give_the_bits_of_the_released_firmware() {
    let model = results(&mut setup(None).session().expect("it fits"));
    let Some(path) = std::env::var_os("CC67_FIRMWARE") else { return };
    let firmware = BootedFirmware::open(path.as_ref()).expect("a firmware file");
    let setup = setup(Some(&firmware));
    let board = results(&mut setup.session_on_firmware(&firmware).expect("it fits"));
    let mut worse = String::new();
    let shares = model.chunks(ARGUMENTS as usize).zip(board.chunks(ARGUMENTS as usize));
    for ((call, _, least), (model, board)) in FUNCTIONS.iter().zip(shares) {
        let equal = model.iter().zip(board).filter(|(model, board)| model == board).count() as u32;
        let line = format!("{call:24} {:6.2} %\n", f64::from(equal) / f64::from(ARGUMENTS) * 100.0);
        print!("{line}");
        if let Some((model, board)) = model.iter().zip(board).find(|(model, board)| model != board) {
            println!("    {model:016X} on the model, {board:016X} on the firmware");
        }
        if equal < *least {
            worse += &line;
        }
    }
    assert!(worse.is_empty(), "fewer equal results than before:\n{worse}");
}
