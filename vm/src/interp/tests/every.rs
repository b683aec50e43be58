//! Every handler, very often in one slice: one that does not continue by a jump would use up the host's stack.

use std::sync::Arc;

use kmotiondef::map::program_base;
use kmotiondef::{Cycles, Ticks};

use crate::engine::{ContextId, Executor, Slice, Stop};
use crate::interp::BytecodeEngine;
use crate::interp::sequences::SEQUENCES;
use crate::memory::GuestMemory;
use crate::op::{OPCODES, Op, WORD};
use crate::testing::{Fake, thread};
use crate::text::assemble;
use crate::thread::Threads;
use crate::verify::verify;

/// Turns of the loop that has every handler once.
const TURNS: u32 = 20_000;

/// The host's stack: there is not room for a frame a turn.
const HOST_STACK: usize = 0x4_0000;

/// Signatures `()` and from each class to itself, constants, and a function of each signature.
const HEAD: &str = "
program 1, 2
word 0x4004000000000000
word 0x123456789abcdef0
sig 0, 0
sig 1, 1\ntypes 0
sig 1, 2\ntypes 1
sig 1, 3\ntypes 2
sig 1, 4\ntypes 3
sig 6, 0\ntypes 0xf80
@pass_i32: func sig1, 1, 0\ntypes 0\ncharge 9\nret_i32 r0
@pass_i64: func sig2, 1, 0\ntypes 1\ncharge 9\nret_i64 l0
@pass_f32: func sig3, 1, 0\ntypes 2\ncharge 9\nret_f32 f0
@pass_f64: func sig4, 1, 0\ntypes 3\ncharge 9\nret_f64 d0
@take: func sig5, 6, 0\ntypes 0xf80\ncharge 9\nret
@nothing: func sig0, 0, 0\ncharge 9\nret
";

/// Instructions that are not for the loop, or only together with others.
const SPECIAL: [&str; 23] = [
    "program",
    "sig",
    "types",
    "func",
    "charge",
    "call",
    "call_ptr",
    "call_fw",
    "br_table",
    "unreachable",
    "ret",
    "ret_i32",
    "ret_i64",
    "ret_f32",
    "ret_f64",
    "arg_i32",
    "arg_i64",
    "arg_f32",
    "arg_f64",
    "result_i32",
    "result_i64",
    "result_f32",
    "result_f64",
];

/// The instruction with a register of its class wherever it has one, and an address of RAM.
fn line(code: u16, label: &str) -> String {
    let mut word = [0; WORD];
    word[..2].copy_from_slice(&code.to_le_bytes());
    let op = Op::decode(word).expect("it is an opcode");
    // The first operand is what is written, for most: not the register with the address.
    let written = op.to_string().replacen(&format!("{} r0", op.name()), &format!("{} r1", op.name()), 1);
    let line = written.replace("l0", "l4").replace("f0", "f8").replace("d0", "d12");
    line.replace("0x00000000", "0x10000010").replace("@0", label) + "\n"
}

/// Code that has the instructions of `codes` in a row; nothing if one of them is special.
fn piece(number: usize, codes: &[u16]) -> String {
    let label = format!("@l{number}");
    // A sequence ends with the `charge` that every piece ends with.
    let is_charged =
        codes.len() > 1 && codes.last().is_some_and(|code| Op::NAMES[usize::from(*code)] == "charge");
    let codes = &codes[..codes.len() - usize::from(is_charged)];
    if codes.iter().any(|code| SPECIAL.contains(&Op::NAMES[usize::from(*code)])) {
        return String::new();
    }
    let lines: String = codes.iter().map(|code| line(*code, &label)).collect();
    let set = "const_i32 r0, 0x10000010\nmov_i32 r1, r0\nconst_i64 l4, pool[1]\nconst_f64 d12, pool[0]";
    format!("charge 2000\n{set}\n{lines}{label}: charge 2000\n")
}

/// Code that calls a function with the value of a register.
fn call(class: &str, register: &str) -> String {
    format!("arg_{class} {register}, 0\ncall fn@pass_{class}\nresult_{class} {register}\ncharge 2000\n")
}

/// Arguments of each class that are not the last one: two in a row, then one by one; and a table.
const MORE: &str = "arg_i32 r0, 0\narg_i32 r0, 1\narg_i32 r0, 2\narg_f32 f8, 3\narg_f64 d12, 4\narg_f64 d12, 5\n\
                    call fn@take\ncharge 2000\nbr_table r3, 0\nbr @behind\n@behind: charge 2000\n";

/// A program whose `main` does everything.
fn everything() -> String {
    let each = (0..OPCODES).map(|code| vec![code]);
    let rows = SEQUENCES.iter().map(|sequence| sequence.to_vec());
    let pieces: String = each.chain(rows).enumerate().map(|(number, codes)| piece(number, &codes)).collect();
    let calls = [("i32", "r0"), ("i64", "l4"), ("f32", "f8"), ("f64", "d12")];
    let calls: String = calls.iter().map(|(class, register)| call(class, register)).collect();
    format!(
        "{HEAD}@main: func sig0, 16, 2\ntypes 0xffaa5500\ncharge 9\nconst_i32 r3, {TURNS}\n@turn: {pieces}{calls}{MORE}\
         call fn@nothing\ncharge 2000\nadd_i32_imm r3, r3, -1\nbr_if r3, @turn\ncharge 9\nret\n"
    )
}

/// Runs the program in one slice; how it stopped.
fn run_everything() -> Stop {
    let text = assemble(&everything()).expect("the text is correct");
    let program = Arc::new(verify(&text, program_base(thread(1))).expect("the program is correct"));
    let main = program.functions().last().expect("there is `main`").at;
    let entry = program.address_of(main.0 as usize).as_guest_addr();
    let id = ContextId::of(thread(1));
    let (mut engine, mut firmware) = (BytecodeEngine::default(), Fake::new());
    let started = engine.start(id, &program, entry, id.stack(false), &firmware);
    assert_eq!(started, Ok(()));
    let length = Cycles::new(i64::from(TURNS) * 1_000_000);
    let mut slice = Slice {
        memory: &mut GuestMemory::new(),
        threads: &mut Threads::new(),
        firmware: &mut firmware,
        tick: Ticks::new(1),
        start: Cycles::new(0),
        length,
        budget: length,
        woken: None,
        is_long: false,
    };
    engine.resume(id, &mut slice)
}

#[test]
fn a_slice_takes_no_stack_of_the_host_however_long_it_is() {
    let runner = std::thread::Builder::new().stack_size(HOST_STACK).spawn(run_everything);
    let stop = runner.expect("a thread can be started").join().expect("it does not panic");
    assert_eq!(stop, Stop::Ended);
}
