//! Every handler, very often in one slice: a handler that does not continue by a jump would overflow the host's stack.

use std::sync::Arc;

use kmotiondef::map::program_base;
use kmotiondef::{Cycles, Ticks};

use crate::engine::{ContextId, Executor, Polling, Slice, Stop};
use crate::interp::BytecodeEngine;
use crate::interp::parts::DST;
use crate::interp::sequences::{LinkedOp, SEQUENCES};
use crate::memory::GuestMemory;
use crate::op::{OPCODES, Op, WORD};
use crate::testing::{Fake, thread};
use crate::text::assemble;
use crate::thread::Threads;
use crate::verify::verify;

/// The number of iterations of the loop that contains every handler.
const ITERATIONS: u32 = 20_000;

/// The size of the host's stack in bytes: too small for one frame per iteration.
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

/// Instructions that cannot be in the loop, or only together with others.
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

/// The instruction with a register of the right class for each operand, and an address in RAM.
///
/// It assigns a different register than it reads, unless that is linked with the register that the previous one
/// assigns.
fn line(step: &LinkedOp, label: &str) -> String {
    let mut word = [0; WORD];
    word[..2].copy_from_slice(&step.code.to_le_bytes());
    let op = Op::decode(word).expect("it is an opcode");
    let text = op.to_string();
    let (name, operands) = text.split_once(' ').unwrap_or((&text, ""));
    let mut place = DST;
    let mut written = Vec::new();
    for operand in operands.split(", ") {
        // For most instructions the first operand is written: it must not be the register with the address.
        let is_assigned = place == DST && step.links[0] != DST && !name.starts_with("br");
        written.push(operand_at(operand, is_assigned || step.links.contains(&place)));
        place += if operand.starts_with("0x") { 2 } else { 1 };
    }
    // Sums and products have the value of one operand, so that an address remains one.
    if let "add_i32" = name {
        written[2] = "r2".into();
    }
    if let "mul_i32_imm" = name {
        written[2] = "1".into();
    }
    format!("{name} {}\n", written.join(", ")).replace("0x00000000", "0x10000010").replace("@0", label)
}

/// An operand with a register that the piece has set, or with one that its instructions assign.
fn operand_at(operand: &str, is_assigned: bool) -> String {
    let (set, assigned) = match operand {
        "r0" => ("r0", "r1"),
        "l0" => ("l4", "l5"),
        "f0" => ("f8", "f9"),
        "d0" => ("d12", "d13"),
        other => (other, other),
    };
    if is_assigned { assigned } else { set }.to_owned()
}

/// Code with the instructions of `steps` in sequence; empty if one of them is special.
fn piece(number: usize, steps: &[LinkedOp]) -> String {
    let label = format!("@l{number}");
    // A sequence ends with the `charge` at the end of every piece.
    let is_charged =
        steps.len() > 1 && steps.last().is_some_and(|step| Op::NAMES[usize::from(step.code)] == "charge");
    let steps = &steps[..steps.len() - usize::from(is_charged)];
    if steps.iter().any(|step| SPECIAL.contains(&Op::NAMES[usize::from(step.code)])) {
        return String::new();
    }
    let lines: String = steps.iter().map(|step| line(step, &label)).collect();
    let set = "const_i32 r0, 0x10000010\nconst_i64 l4, pool[1]\nconst_f64 d12, pool[0]\nmov_i32 r1, r0";
    let recalled = match &Op::NAMES[usize::from(steps[0].code)] {
        _ if steps[0].links == [0; 2] => "",
        name if name.ends_with("f32") => "mov_f32 f9, f8\n",
        _ => "mov_f64 d13, d12\n",
    };
    format!("charge 2000\n{set}\n{recalled}{lines}{label}: charge 2000\n")
}

/// Code that calls a function with the value of a register.
fn call(class: &str, register: &str) -> String {
    format!("arg_{class} {register}, 0\ncall fn@pass_{class}\nresult_{class} {register}\ncharge 2000\n")
}

/// Arguments of each class that are not the last one: two in a row, then one by one; and a table.
const MORE: &str = "arg_i32 r0, 0\narg_i32 r0, 1\narg_i32 r0, 2\narg_f32 f8, 3\narg_f64 d12, 4\narg_f64 d12, 5\n\
                    call fn@take\ncharge 2000\nbr_table r3, 0\nbr @behind\n@behind: charge 2000\n";

/// A program whose `main` contains everything.
fn everything() -> String {
    let each = (0..OPCODES).map(|code| vec![LinkedOp { code, links: [0; 2] }]);
    let rows = SEQUENCES.iter().map(|sequence| sequence.to_vec());
    let pieces: String = each.chain(rows).enumerate().map(|(number, steps)| piece(number, &steps)).collect();
    let calls = [("i32", "r0"), ("i64", "l4"), ("f32", "f8"), ("f64", "d12")];
    let calls: String = calls.iter().map(|(class, register)| call(class, register)).collect();
    format!(
        "{HEAD}@main: func sig0, 16, 2\ntypes 0xffaa5500\ncharge 9\nconst_i32 r3, {ITERATIONS}\n@iteration: {pieces}{calls}{MORE}\
         call fn@nothing\ncharge 2000\nadd_i32_imm r3, r3, -1\nbr_if r3, @iteration\ncharge 9\nret\n"
    )
}

/// Runs the program in one slice; returns how it stopped.
fn run_everything() -> Stop {
    let text = assemble(&everything()).expect("the text is correct");
    let program = Arc::new(verify(&text, program_base(thread(1))).expect("the program is correct"));
    let main = program.functions().last().expect("there is `main`").at;
    let entry = program.address_of(main.0 as usize).as_guest_addr();
    let id = ContextId::of(thread(1));
    let (mut engine, mut firmware) = (BytecodeEngine::default(), Fake::new());
    let started = engine.start(id, &program, entry, id.stack(false), &firmware);
    assert_eq!(started, Ok(()));
    let length = Cycles::new(i64::from(ITERATIONS) * 2_000_000);
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
        polling: Polling::OFF,
    };
    engine.resume(id, &mut slice)
}

#[test]
fn a_slice_of_any_length_uses_no_host_stack() {
    let runner = std::thread::Builder::new().stack_size(HOST_STACK).spawn(run_everything);
    let stop = runner.expect("a thread can be started").join().expect("it does not panic");
    assert_eq!(stop, Stop::Ended);
}
