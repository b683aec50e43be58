//! Functions in the processor's mask ROM: TI's fast mathematics.
//!
//! Firmware from version 5 on calls them there. Their code is not in any file, so the processor branches to an address
//! without code, and the board computes the function, in the time that the same function takes in firmware 4.34. The
//! addresses are absolute symbols in the firmware file.

use c67x::Reg;
use c67x::convention::{ARGUMENTS, LINK, RESULT};
use vm::arith::{canonical_f32, canonical_f64};
use vm::dsp::State;

/// The value assigned to registers that a function may have changed.
const CHANGED: u32 = 0xC4A7_6ED0;
/// The number of fraction bits in the processor's estimate of a reciprocal.
const ESTIMATED_BITS: u32 = 8;

/// The formula of a function.
#[derive(Clone, Copy, Debug)]
enum Formula {
    Double(fn(f64) -> f64),
    Doubles(fn(f64, f64) -> f64),
    Single(fn(f32) -> f32),
    Singles(fn(f32, f32) -> f32),
}

/// A function of the ROM.
#[derive(Debug)]
pub(super) struct RomFunction {
    /// Its name in C.
    pub(super) name: &'static str,
    /// The duration of a call in processor cycles, from its first packet to the return.
    pub(super) cycles: u64,
    formula: Formula,
}

macro_rules! functions {
    ($($name:literal $cycles:literal $kind:ident $formula:expr;)*) => {
        /// All functions. The cycles are those of the functions in 4.34; `rsqrt` and `rsqrtf`, which it lacks, have
        /// those of the square roots.
        const FUNCTIONS: &[RomFunction] = &[$(
            RomFunction { name: $name, cycles: $cycles, formula: Formula::$kind($formula) },
        )*];
    };
}

functions! {
    "atan" 335 Double libm::atan;
    "atan2" 565 Doubles libm::atan2;
    "atan2f" 80 Singles libm::atan2f;
    "atanf" 54 Single libm::atanf;
    "_divd" 84 Doubles divd;
    "_divf" 30 Singles divf;
    "exp2" 227 Double libm::exp2;
    "exp10" 227 Double libm::exp10;
    "exp" 214 Double libm::exp;
    "log2" 284 Double libm::log2;
    "log10" 284 Double libm::log10;
    "log" 283 Double libm::log;
    "log2f" 67 Single libm::log2f;
    "log10f" 67 Single libm::log10f;
    "logf" 66 Single libm::logf;
    "pow" 1100 Doubles libm::pow;
    "powf" 680 Singles libm::powf;
    "rsqrt" 379 Double rsqrt;
    "rsqrtf" 41 Single rsqrtf;
    "cos" 148 Double libm::cos;
    "sin" 144 Double libm::sin;
    "cosf" 66 Single libm::cosf;
    "sinf" 62 Single libm::sinf;
    "sqrtf" 41 Single libm::sqrtf;
    "sqrt" 379 Double libm::sqrt;
    "exp2f" 73 Single libm::exp2f;
    "exp10f" 73 Single libm::exp10f;
    "expf" 72 Single libm::expf;
}

/// A quotient by an 8-bit estimate and three of Newton's steps, as 4.34 computes it: not rounded correctly, and NaN if
/// the divisor is 0 (`c67-subset.md` 7).
fn divd(a: f64, b: f64) -> f64 {
    const ESTIMATED: u64 = !0 << (f64::MANTISSA_DIGITS - 1 - ESTIMATED_BITS);
    let estimate = f64::from_bits((1.0 / b).to_bits() & ESTIMATED);
    a * (0..3).fold(estimate, |value, _| value * (2.0 - b * value))
}

/// The quotient as in [`divd`], with two steps.
fn divf(a: f32, b: f32) -> f32 {
    const ESTIMATED: u32 = !0 << (f32::MANTISSA_DIGITS - 1 - ESTIMATED_BITS);
    let estimate = f32::from_bits((1.0 / b).to_bits() & ESTIMATED);
    a * (0..2).fold(estimate, |value, _| value * (2.0 - b * value))
}

/// 1/√x; for 0, the largest number.
fn rsqrt(x: f64) -> f64 {
    if x == 0.0 { f64::MAX } else { 1.0 / libm::sqrt(x) }
}

/// 1/√x; for 0, the largest number.
fn rsqrtf(x: f32) -> f32 {
    if x == 0.0 { f32::MAX } else { 1.0 / libm::sqrtf(x) }
}

impl PartialEq for RomFunction {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for RomFunction {}

/// The function with a name in C.
pub(super) fn named(name: &str) -> Option<&'static RomFunction> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

impl RomFunction {
    /// Calls the function: the processor is at its first packet, and afterwards at its return address, with no results
    /// in flight.
    pub(super) fn call(&self, state: &mut State) {
        state.land_all();
        let [first, second, ..] = ARGUMENTS;
        let (result, is_pair) = match self.formula {
            Formula::Double(formula) => (canonical_f64(formula(double(state, first))).to_bits(), true),
            Formula::Doubles(formula) => {
                let value = formula(double(state, first), double(state, second));
                (canonical_f64(value).to_bits(), true)
            }
            Formula::Single(formula) => {
                (canonical_f32(formula(single_register(state, first))).to_bits().into(), false)
            }
            Formula::Singles(formula) => {
                let value = formula(single_register(state, first), single_register(state, second));
                (canonical_f32(value).to_bits().into(), false)
            }
        };
        let back = state.reg(LINK);
        clobbered_registers().for_each(|reg| state.set_reg(reg, CHANGED));
        state.set_reg(RESULT, result as u32);
        if is_pair {
            state.set_reg(RESULT.pair().high(), (result >> 32) as u32);
        }
        state.set_pc(back);
    }
}

fn single_register(state: &State, reg: Reg) -> f32 {
    f32::from_bits(state.reg(reg))
}

fn double(state: &State, reg: Reg) -> f64 {
    let (low, high) = (state.reg(reg), state.reg(reg.pair().high()));
    f64::from_bits(u64::from(low) | u64::from(high) << 32)
}

/// The registers that a function may change: A0 to A9 and B0 to B9 except the return address, A16 to A31, B16 to B31.
fn clobbered_registers() -> impl Iterator<Item = Reg> {
    let numbers = || (0..10).chain(16..32);
    numbers().flat_map(|number| [Reg::a(number), Reg::b(number)]).filter(|reg| *reg != LINK)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BACK: u32 = 0x8000_1234;

    /// A processor that is about to call a function with two doubles.
    fn state(a: f64, b: f64) -> State {
        let mut state = State::default();
        state.set_pc(0x2C000);
        state.set_reg(LINK, BACK);
        for (reg, value) in ARGUMENTS.into_iter().zip([a.to_bits(), b.to_bits()]) {
            state.set_reg(reg, value as u32);
            state.set_reg(reg.pair().high(), (value >> 32) as u32);
        }
        state
    }

    #[test]
    fn doubles_come_and_go_in_pairs_and_singles_in_one_register() {
        for (name, a, b, expect) in [
            ("_divd", 1.0, 4.0, 0.25),
            // As recorded: the number next to the correct quotient.
            ("_divd", 3.0, 10.0, f64::from_bits(0x3FD3_3333_3333_3334)),
            ("pow", 2.0, 10.0, 1024.0),
            ("atan2", 1.0, -1.0, 3.0 * std::f64::consts::FRAC_PI_4),
            ("sqrt", 2.25, 7.0, 1.5),
            ("rsqrt", 0.0, 7.0, f64::MAX),
            ("rsqrt", 16.0, 7.0, 0.25),
        ] {
            let mut state = state(a, b);
            named(name).expect(name).call(&mut state);
            assert_eq!((double(&state, RESULT), state.pc()), (expect, BACK), "{name}");
        }
        for (name, a, b, expect) in [
            ("_divf", 1.0_f32, 3.0_f32, 1.0 / 3.0),
            ("powf", 2.0, 10.0, 1024.0),
            ("rsqrtf", 0.0, 1.0, f32::MAX),
        ] {
            let mut state = state(0.0, 0.0);
            state.set_reg(ARGUMENTS[0], a.to_bits());
            state.set_reg(ARGUMENTS[1], b.to_bits());
            named(name).expect(name).call(&mut state);
            assert_eq!(single_register(&state, RESULT), expect, "{name}");
        }
    }

    #[test]
    fn a_call_keeps_the_registers_that_belong_to_the_caller() {
        let mut state = state(1.0, 2.0);
        let kept: Vec<Reg> = (10..16).flat_map(|number| [Reg::a(number), Reg::b(number)]).collect();
        for (reg, value) in kept.iter().zip(100..) {
            state.set_reg(*reg, value);
        }
        named("sin").expect("sin").call(&mut state);
        for (reg, value) in kept.iter().zip(100..) {
            assert_eq!(state.reg(*reg), value, "{reg:?}");
        }
        assert_eq!([Reg::a(31), Reg::b(0), Reg::b(9)].map(|reg| state.reg(reg)), [CHANGED; 3]);
    }

    #[test]
    fn undefined_results_are_the_same_nan_on_every_computer() {
        let mut state = state(0.0, 0.0);
        named("_divd").expect("_divd").call(&mut state);
        assert_eq!(double(&state, RESULT).to_bits(), canonical_f64(f64::NAN).to_bits());
    }
}
