//! Words to text and back, for the recorded instructions and for random fields.

mod gnu;

use std::fs;

use c67x::{Inst, Kind, Op, Operand, Reg, Side, assemble};
use proptest::prelude::*;
use serde_json::Value;

use self::gnu::gnu_text;

const PLACE: u32 = 0x1002_0000;

fn recorded() -> Vec<Value> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/instructions.jsonl");
    let text = fs::read_to_string(path).expect("recorded instructions");
    text.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect()
}

fn hex(value: &Value) -> u32 {
    u32::from_str_radix(value.as_str().expect("a string"), 16).expect("a word")
}

#[test]
fn recorded_words_have_the_recorded_text() {
    let lines = recorded();
    assert_eq!(lines.len(), 8528);
    for line in lines {
        let word = hex(&line["w"]);
        let at = line.get("pc").map_or(PLACE, hex);
        let inst = Inst::decode(word).unwrap_or_else(|error| panic!("{error}: {line}"));
        assert_eq!(line["id"], inst.op().id(), "{line}");
        assert_eq!(line["asm"], gnu_text(inst, at), "{line}");
    }
}

#[test]
fn recorded_words_are_assembled_again_from_their_text() {
    for line in recorded() {
        let word = hex(&line["w"]);
        let at = line.get("pc").map_or(PLACE, hex);
        let inst = Inst::decode(word).expect("a recorded word");
        check_text(inst, at);
    }
}

fn check_text(inst: Inst, at: u32) {
    let text = inst.text(at);
    let read = assemble(&text, at).unwrap_or_else(|error| panic!("{text}: {error}")).inst;
    assert_eq!(read, inst, "{text}");
    let relative = inst.to_string();
    assert_eq!(assemble(&relative, 0).expect("its own text").inst, inst, "{relative}");
}

/// A word of the form with random fields: all bits not in the mask are random.
fn word_of(op: Op, random: u32) -> Option<u32> {
    let row = op.row();
    let word = row.value | random & !row.mask & !1;
    Inst::decode(word).is_ok_and(|inst| inst.op() == op).then_some(word)
}

proptest! {
    #[test]
    fn every_form_survives_a_round_trip(randoms in prop::collection::vec(any::<u32>(), Op::ALL.len())) {
        for (op, random) in Op::ALL.iter().zip(randoms) {
            let Some(word) = word_of(*op, random) else { continue };
            let inst = Inst::decode(word).expect("its form");
            prop_assert_eq!(inst.encode(false), word);
            prop_assert_eq!(inst.encode(true), word | 1);
            check_text(inst, PLACE);
            let operands: Vec<Operand> = inst.operands().collect();
            let side = inst.unit().map_or(Side::A, |unit| unit.side);
            let made = Inst::new(*op, side, inst.pred(), &operands).expect("its own operands");
            // Only in forms with one source pair, a field, src1, is not among the operands.
            let pair = inst.op().row().operands.iter().any(|(_, kind)| *kind == Kind::Dodd);
            let ignored = if pair { 31 << 13 } else { 0 };
            prop_assert_eq!((made.op(), made.encode(false) & !ignored), (*op, word & !ignored));
        }
    }

    #[test]
    fn any_word_is_an_instruction_or_an_error(word in any::<u32>()) {
        if let Ok(inst) = Inst::decode(word) {
            check_text(inst, PLACE);
            prop_assert!(inst.reads().chain([]).all(|read| read.first >= 1 && read.first <= read.last));
            prop_assert!(inst.writes().all(|write| write.stage >= 1 && write.stage <= inst.delay_slots() + 1));
        }
    }
}

#[test]
fn every_form_is_reached_by_random_fields() {
    for op in Op::ALL {
        let tries = (0..64u32).map(|turn| turn.wrapping_mul(0x9E37_79B9));
        assert!(tries.filter_map(|random| word_of(*op, random)).count() > 0, "{}", op.id());
    }
}

#[test]
fn forms_are_found_by_name_and_operands() {
    let operands = [Reg::a(4).into(), Reg::a(5).into(), Reg::a(6).into()];
    let forms: Vec<String> = Inst::forms(c67x::Mnemonic::Add, c67x::Pred::Always, &operands)
        .map(|inst| inst.to_string())
        .collect();
    assert_eq!(forms, ["ADD .L1 A4,A5,A6", "ADD .S1 A4,A5,A6", "ADD .D1 A4,A5,A6"]);
}
