//! The firmware functions that test programs call, reduced to their interface.

use std::collections::BTreeMap;
use std::fmt::Write;

use c67x::Reg;
use kmotiondef::GuestAddr;
use vm::dsp::Core;

use super::machine::{Ram, scramble};
use crate::c67x::abi;
use crate::link::LinkedProgram;

pub(super) struct Firmware {
    names: BTreeMap<u32, String>,
    pub(super) console: String,
    calls: u32,
}

impl Firmware {
    pub(super) fn new(linked: &LinkedProgram) -> Self {
        let names = linked.firmware.imports.iter().map(|import| (import.address.get(), import.name.clone()));
        Self { names: names.collect(), console: String::new(), calls: 0 }
    }

    /// Executes the function at an address.
    pub(super) fn call(&mut self, address: GuestAddr, core: &mut Core, ram: &mut Ram) {
        let name = self.names.get(&address.get()).cloned();
        let name = name.unwrap_or_else(|| panic!("call of {address}, where nothing is"));
        let word = |index: usize| core.state.reg(abi::ARGUMENTS[index]);
        let int = |index: usize| word(index).cast_signed();
        let double = |index: usize| {
            let low = abi::ARGUMENTS[index];
            let high = core.state.reg(low.pair().high());
            f64::from_bits(u64::from(core.state.reg(low)) | u64::from(high) << 32)
        };
        let single = |index: usize| f32::from_bits(word(index));
        let stack = core.state.reg(Reg::b(15));
        assert_eq!(stack % 8, 0, "the stack pointer of a call");
        let result = match name.as_str() {
            "_divi" => Result::Word(int(0).wrapping_div(int(1)).cast_unsigned()),
            "_remi" => Result::Word(int(0).wrapping_rem(int(1)).cast_unsigned()),
            "_divu" => Result::Word(word(0) / word(1)),
            "_remu" => Result::Word(word(0) % word(1)),
            // Not correctly rounded, as on the board.
            "_divf" => Result::Word((single(0) / single(1)).to_bits() ^ 1),
            "_divd" => Result::Double(f64::from_bits((double(0) / double(1)).to_bits() ^ 3)),
            "sqrt" => Result::Double(double(0).sqrt()),
            "sin" | "cos" => {
                expect_wait(core, ram);
                let angle = double(0);
                Result::Double(if name == "sin" { libm::sin(angle) } else { libm::cos(angle) })
            }
            "exp" => Result::Double(libm::exp(double(0))),
            "log" => Result::Double(libm::log(double(0))),
            "atan2" => Result::Double(libm::atan2(double(0), double(1))),
            "sqrtf" => Result::Word(single(0).sqrt().to_bits()),
            "sinf" => Result::Word(libm::sinf(single(0)).to_bits()),
            "logf" => Result::Word(libm::logf(single(0)).to_bits()),
            "Time_sec" => Result::Double(1.0),
            "Delay_sec" | "WaitNextTimeSlice" => Result::Word(0),
            "memcpy" => {
                let bytes: Vec<u8> = (0..word(2)).map(|at| ram.byte(word(1) + at)).collect();
                ram.set_bytes(word(0), &bytes);
                Result::Word(word(0))
            }
            "memset" => {
                ram.set_bytes(word(0), &vec![word(1) as u8; word(2) as usize]);
                Result::Word(word(0))
            }
            "printf" => {
                let text = format(ram, ram.word(stack + 4), stack + 8);
                self.console += &text;
                Result::Word(text.len() as u32)
            }
            "sprintf" => {
                let text = format(ram, ram.word(stack + 4), stack + 8);
                ram.set_bytes(word(0), text.as_bytes());
                ram.set(word(0) + text.len() as u32, 0);
                Result::Word(text.len() as u32)
            }
            other => panic!("the firmware of the tests has no {other}"),
        };
        self.calls += 1;
        let back = core.state.reg(abi::LINK);
        scramble(core, abi::CHANGED, self.calls);
        // The memory at and below the stack pointer belongs to interrupts.
        (0..40).for_each(|at| ram.set_bytes(stack - 4 * at, &self.calls.wrapping_mul(77).to_le_bytes()));
        core.state.set_reg(abi::LINK, back);
        match result {
            Result::Word(word) => core.state.set_reg(abi::RESULT, word),
            Result::Double(value) => {
                core.state.set_reg(abi::RESULT, value.to_bits() as u32);
                core.state.set_reg(abi::RESULT.pair().high(), (value.to_bits() >> 32) as u32);
            }
        }
    }
}

enum Result {
    Word(u32),
    Double(f64),
}

/// `printf`, with the conversions used in the test programs.
fn format(ram: &Ram, at: u32, mut next: u32) -> String {
    let (mut out, text) = (String::new(), ram.text(at));
    let mut chars = text.chars().peekable();
    while let Some(char) = chars.next() {
        if char != '%' {
            out.push(char);
            continue;
        }
        let mut spec = String::new();
        let conversion = loop {
            match chars.next() {
                Some(char) if char.is_ascii_digit() || "-+ .#l".contains(char) => spec.push(char),
                Some(char) => break char,
                None => return out,
            }
        };
        let (flags, precision) = spec.split_once('.').unwrap_or((&spec, ""));
        let width: usize = flags.trim_matches(['-', '+', 'l']).parse().unwrap_or(0);
        let digits: Option<usize> = precision.parse().ok();
        let mut word = || {
            next += 4;
            ram.word(next - 4)
        };
        let body = match conversion {
            '%' => "%".to_owned(),
            'd' | 'i' => word().cast_signed().to_string(),
            'u' => word().to_string(),
            'x' => format!("{:x}", word()),
            'X' => format!("{:X}", word()),
            'o' => format!("{:o}", word()),
            'c' => char::from(word() as u8).to_string(),
            's' => ram.text(word()),
            _ => {
                next = next.next_multiple_of(8);
                let bits = u64::from(ram.word(next)) | u64::from(ram.word(next + 4)) << 32;
                next += 8;
                float(f64::from_bits(bits), conversion, digits.unwrap_or(6))
            }
        };
        let missing = width.saturating_sub(body.len());
        if flags.starts_with('-') {
            let _ = write!(out, "{body}{}", " ".repeat(missing));
        } else if flags.starts_with('0') {
            let _ = write!(out, "{}{body}", "0".repeat(missing));
        } else {
            let _ = write!(out, "{}{body}", " ".repeat(missing));
        }
    }
    out
}

fn float(value: f64, conversion: char, digits: usize) -> String {
    let exponent = |digits: usize| {
        let text = format!("{value:.digits$e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let exponent: i32 = exponent.parse().unwrap_or(0);
        (mantissa.to_owned(), exponent)
    };
    let join = |mantissa: &str, exponent: i32| {
        format!("{mantissa}e{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs())
    };
    let text = match conversion {
        'f' => format!("{value:.digits$}"),
        'e' | 'E' => {
            let (mantissa, exponent) = exponent(digits);
            join(&mantissa, exponent)
        }
        _ => {
            let digits = digits.max(1);
            let (mantissa, exponent) = exponent(digits - 1);
            let trim = |text: &str| {
                if text.contains('.') {
                    text.trim_end_matches('0').trim_end_matches('.').to_owned()
                } else {
                    text.to_owned()
                }
            };
            if exponent < -4 || exponent >= digits as i32 {
                join(&trim(&mantissa), exponent)
            } else {
                trim(&format!("{value:.*}", (digits as i32 - 1 - exponent).max(0) as usize))
            }
        }
    };
    if conversion.is_ascii_uppercase() { text.to_uppercase() } else { text }
}

/// These functions still write A7 in the cycle after their return.
fn expect_wait(core: &Core, ram: &Ram) {
    let mut at = core.state.reg(abi::LINK);
    loop {
        let word = ram.word(at);
        let inst = c67x::Inst::decode(word).expect("an instruction after a call");
        assert!(
            inst.writes().all(|write| write.reg != abi::LATE || write.stage > 1),
            "{} at {at:08x}, which writes what the function writes",
            inst.text(at)
        );
        if word & c67x::PARALLEL == 0 {
            break;
        }
        at += 4;
    }
}
