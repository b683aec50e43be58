//! Programs of random instructions, straight from the instruction table.
//!
//! A program is a `main` of blocks with random branches between them, and a function that calls itself. Each class has
//! four registers, whose initial values are edge cases of the operations. Most addresses are valid.

use std::fmt::Write as _;

use crate::for_each_op;
use crate::op::Op;
use crate::operand::{
    Addr, Bits32, Classes, Count, Count32, FuncRef, Imm, Imm16, Label, Off, Pool, RegF32, RegF64, RegI32,
    RegI64, SigRef,
};

/// Edge cases of integers, of doubles, and of pairs of floats.
pub(super) const NUMBERS: &[u64] = &[
    0,
    1,
    0xffff_ffff_ffff_ffff,
    0x8000_0000_0000_0000,
    0x7fff_ffff_ffff_ffff,
    0x0000_0000_8000_0000,
    0x0000_0020_0000_0040,
    0x0000_001f_ffff_ffff,
    0x3ff0_0000_0000_0000,
    0xc004_0000_0000_0000,
    0x41ef_ffff_ffe0_0000,
    0xc1e0_0000_0000_0000,
    0x41df_ffff_ffff_ffff,
    0x43e0_0000_0000_0000,
    0xc3e0_0000_0000_0001,
    0x43f0_0000_0000_0001,
    0x7ff0_0000_0000_0000,
    0xfff0_0000_0000_0000,
    0x7ff8_0000_0000_0000,
    0xfff8_0000_0000_1234,
    0x7ff0_0000_0000_0001,
    0x0000_0000_0000_0003,
    0x7f80_0001_ffc0_1234,
    0x4f80_0000_cf00_0000,
    0x3f80_0000_7f7f_ffff,
    0x7f80_0000_ff80_0000,
    0x47ef_ffff_f000_0000,
    0x3690_0000_0000_0001,
];

/// Addresses: most of them in RAM, some at its end, some in text, devices, flash and unmapped memory.
const ADDRESSES: &[u32] = &[
    0x80f0_0000,
    0x80f0_0020,
    0x80f0_0048,
    0x80f0_0100,
    0x80f0_0208,
    0x80f0_0310,
    0x1000_0400,
    0x1000_0440,
    0x800c_7f00,
    0x800c_0000,
    0x8005_8000,
    0x8005_ffc0,
    0x80f0_0404,
    0x80f0_0502,
    0x80f0_0601,
    0x1000_0204,
    0x80ff_fff8,
    0x80ff_fffc,
    0x1001_fff8,
    0x8005_0000,
    0x9100_0010,
    0x4200_0010,
    0x9000_0100,
    0x8000_0000,
    0x8005_0b00,
    0,
    0x7fff_fffc,
];

/// A generator of random numbers.
pub(super) struct Random {
    state: u64,
    /// The registers for the integers of an instruction.
    integers: (u16, u16),
}

impl Random {
    fn below(&mut self, end: usize) -> usize {
        // An xorshift generator (Marsaglia); the upper half is the better one.
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        (self.state >> 32) as usize % end
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }
}

/// An operand that can be chosen at random.
trait Generate {
    fn generate(random: &mut Random) -> Self;
}

macro_rules! generate {
    ($($operand:ident = |$random:ident| $value:expr;)*) => {$(
        impl Generate for $operand {
            fn generate($random: &mut Random) -> Self {
                $operand($value)
            }
        }
    )*};
}
generate! {
    RegI32 = |r| r.integers.0 + r.below(usize::from(r.integers.1)) as u16;
    RegI64 = |r| 4 + r.below(4) as u16;
    RegF32 = |r| 8 + r.below(4) as u16;
    RegF64 = |r| 12 + r.below(4) as u16;
    Imm = |r| r.pick(&[0, 1, -1, 8, 16, i32::MIN, i32::MAX, 31, 32, 33, 63, 64]);
    Imm16 = |r| r.pick(&[0, 1, -1, 2, 31, 32, 40, 63, 64, 255, i16::MIN, i16::MAX]);
    Bits32 = |r| r.pick(&[0, 0x8000_0000, 0x3f80_0000, 0x7f80_0000, 0xffc0_0001, 0x7f80_0001, 0x4f80_0000]);
    Off = |r| r.pick(&[0, 0, 0, 0, 8, -8, 16, 4, 2, 1]);
    Addr = |r| r.pick(ADDRESSES);
    Pool = |r| r.below(2) as u32;
    Count = |r| r.pick(&[0, 1, 4, 7, 16, 40]);
    Count32 = |_r| 0;
    Label = |_r| 0;
    FuncRef = |_r| 0;
    SigRef = |_r| 0;
    Classes = |_r| 0;
}

macro_rules! define_generators {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        type Generator = fn(&mut Random) -> Op;

        /// Names and generators of all instructions.
        const GENERATORS: &[(&str, Generator)] = &[
            $((stringify!($name), |_random| Op::$variant { $($field: Generate::generate(_random)),* }),)*
        ];
    };
}
for_each_op!(define_generators);

/// Instructions with which a generated block ends, or which it contains separately.
const CONTROL: &[&str] =
    &["program", "sig", "types", "func", "charge", "br", "arg_", "call", "result_", "ret", "unreachable"];

fn is_plain(name: &str) -> bool {
    !CONTROL.iter().any(|control| name.starts_with(control))
}

fn uses_addresses(name: &str) -> bool {
    (name.starts_with("load_") || name.starts_with("store_") || name == "copy" || name == "clear")
        && !name.ends_with("_at")
}

/// The text of a program.
pub(super) fn program(seed: u64) -> String {
    let mut random = Random { state: seed | 1, integers: (0, 4) };
    let mut text = recursion();
    text.push_str("@main: func sig0, 16, 4\ntypes 0xffaa5500\n");
    begin_registers(&mut random, &mut text);
    let blocks = 2 + random.below(6);
    for block in 0..blocks {
        let _ = writeln!(text, "@b{block}: charge {}", 5000 + random.below(100));
        for _ in 0..random.below(10) {
            instruction(&mut random, &mut text);
        }
        end_block(&mut random, &mut text, block, blocks);
    }
    let _ = writeln!(text, "@b{blocks}: charge 5000");
    end_registers(&mut text);
    text.push_str("ret\n");
    text
}

/// The first function, at word 11: returns the exclusive or of its argument and its result for the argument minus one.
fn recursion() -> String {
    "@f: func sig3, 2, 1\ntypes 0\ncharge 30\nadd_i32_imm r1, r0, -1\nlt_i32_s r1, r0, r1\nbr_if r1, @out\n\
     charge 30\nadd_i32_imm r1, r0, -1\nbr_unless r0, @out\ncharge 30\narg_i32 r1, 0\ncall fn@f\nresult_i32 r1\n\
     charge 30\nxor_i32 r0, r0, r1\n@out: charge 30\nret_i32 r0\n"
        .to_owned()
}

fn begin_registers(random: &mut Random, text: &mut String) {
    text.push_str("charge 5000\n");
    let classes = [("load_i32_at r", 0), ("load_i64_at l", 4), ("load_f32_at f", 8), ("load_f64_at d", 12)];
    for (load, first) in classes {
        for register in first..first + 4 {
            let address = super::NUMBERS as usize + 8 * random.below(NUMBERS.len());
            let _ = writeln!(text, "{load}{register}, {address:#x}");
        }
    }
}

fn end_registers(text: &mut String) {
    let classes =
        [("store_i32_at r", 0), ("store_i64_at l", 4), ("store_f32_at f", 8), ("store_f64_at d", 12)];
    for (store, first) in classes {
        for register in first..first + 4 {
            let _ = writeln!(text, "{store}{register}, {:#x}", super::NUMBERS + 0x800 + 8 * register);
        }
    }
}

fn instruction(random: &mut Random, text: &mut String) {
    if random.below(12) == 0 {
        return call(random, text);
    }
    let (name, generator) = random.pick(GENERATORS);
    if !is_plain(name) {
        return;
    }
    random.integers = (0, 4);
    if uses_addresses(name) {
        // Here r2 and r3 are addresses.
        for register in 2..4 {
            let good = 18 + usize::from(random.below(8) == 0) * (ADDRESSES.len() - 18);
            let address = ADDRESSES[random.below(good)].cast_signed();
            let _ = writeln!(text, "const_i32 r{register}, {address}");
        }
        random.integers = (2, 2);
    }
    let op = generator(random);
    let _ = writeln!(text, "{op}");
}

fn call(random: &mut Random, text: &mut String) {
    let integer = random.below(4);
    let call = match random.below(8) {
        0 => format!("arg_i32 r{integer}, 0\ncall_fw sig1, 0x10008000"),
        1 => format!("arg_i32 r{integer}, 0\ncall_fw sig1, 0x10008008"),
        2 => "call_fw sig0, 0x10008010".to_owned(),
        3 => format!("arg_i32 r{integer}, 0\narg_f64 d13, 1\ncall_fw sig4, 0x10008040\nresult_f64 d12"),
        4 => format!("const_i32 r1, 1\narg_i32 r1, 0\ncall_fw sig1, 0x10008030 ; {integer}"),
        5 => format!("and_i32_imm r0, r{integer}, 63\narg_i32 r0, 0\ncall fn@f\nresult_i32 r2"),
        // The function is at word 11.
        6 => format!(
            "const_i32 r1, {}\narg_i32 r{integer}, 0\ncall_ptr r1, sig3\nresult_i32 r3",
            0x8005_0058_u32.cast_signed()
        ),
        _ => format!("const_i32 r1, 0x10008000\narg_i32 r{integer}, 0\ncall_ptr r1, sig3\nresult_i32 r3"),
    };
    let _ = writeln!(text, "{call}\ncharge 5000");
}

fn end_block(random: &mut Random, text: &mut String, block: usize, blocks: usize) {
    let target = random.below(blocks + 1);
    let register = random.below(4);
    let _ = match random.below(6) {
        0 => writeln!(text, "br_if r{register}, @b{target}"),
        1 => writeln!(text, "br_unless r{register}, @b{target}"),
        2 => writeln!(text, "br @b{target}"),
        3 => {
            let other = random.below(blocks + 1);
            writeln!(text, "br_table r{register}, 2\nbr @b{target}\nbr @b{other}\nbr @b{}", block + 1)
        }
        4 if random.below(8) == 0 => writeln!(text, "ret"),
        _ => Ok(()),
    };
}
