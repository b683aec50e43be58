//! Programs that the verifier accepts or rejects.

use kmotiondef::GuestAddr;
use proptest::prelude::*;

use super::verify;
use crate::op::WORD;
use crate::testing::{HEAD_WORDS, bytes};

const BASE: GuestAddr = GuestAddr::new(0x8005_0000);

/// The message for a program of `functions`; `ok` if there is none.
fn message(functions: &str) -> String {
    verify(&bytes(functions), BASE).map_or_else(|error| error.to_string(), |_| "ok".to_owned())
}

/// Checks a program of one function of `sig0` with registers r0, r1, l2, d3.
fn check(body: &str, expected: &str) {
    let body = body.replace(" | ", "\n");
    assert_eq!(message(&format!("func sig0, 4, 0\ntypes 0xd0\n{body}")), expected, "{body}");
}

#[test]
fn a_correct_program_passes() {
    check("charge 2 | ret", "ok");
    check("charge 9 | ret", "ok");
    check("@up: charge 3 | add_i32_imm r0, r0, 1 | br_if r0, @up | charge 2 | ret", "ok");
    check("charge 7 | arg_i32 r0, 0 | call_fw sig3, 0x10000000 | result_i32 r0 | charge 2 | ret", "ok");
    check("charge 3 | br_table r0, 1 | br @a | br @a | @a: charge 2 | ret", "ok");
}

#[test]
fn operands_must_name_what_exists() {
    check("charge 3 | mov_i32 r0, r4 | ret", "word 14: the function has no register 4");
    check("charge 3 | mov_i32 r0, r2 | ret", "word 14: register 2 holds i64, not i32");
    check("charge 3 | const_i64 l2, pool[2] | ret", "word 14: the pool has no constant 2");
    check("charge 6 | call_fw sig9, 0 | ret", "word 14: the program has no signature 9");
    check("charge 6 | call fn@3 | ret", "word 14: no function starts at word 3");
}

#[test]
fn branches_stay_in_their_function_and_out_of_groups() {
    check("charge 1 | br @11", "word 14: word 11 cannot be the target of a branch here");
    check("charge 1 | br @15", "word 14: word 15 cannot be the target of a branch here");
    let group = "charge 5 | arg_i32 r0, 0 | @call: call_fw sig1, 0x10000000 | charge 1 | br @call";
    check(group, "word 17: word 15 cannot be the target of a branch here");
    let table = "charge 4 | br_table r0, 0 | @inside: br @inside";
    check(table, "word 15: word 15 cannot be the target of a branch here");
    check("charge 4 | br_table r0, 1 | br @13 | ret", "word 14: the table must be followed by 2 `br` words");
}

#[test]
fn calls_are_contiguous_and_match_their_signature() {
    let order = "word 14: the arguments of a call must be in order directly before it";
    check("charge 9 | arg_i32 r0, 1 | call_fw sig1, 0 | charge 2 | ret", order);
    let alone = "word 15: the arguments of a call must be in order directly before it";
    check("charge 9 | arg_i32 r0, 0 | ret", alone);
    let classes = "word 15: the arguments of the call are not those of its signature";
    check("charge 9 | arg_i64 l2, 0 | call_fw sig1, 0 | charge 2 | ret", classes);
    let missing = "word 14: the arguments of the call are not those of its signature";
    check("charge 9 | call_fw sig1, 0 | charge 2 | ret", missing);
    let result = "word 15: no call with this class of result stands directly before";
    check("charge 9 | call_fw sig0, 0 | result_i32 r0 | charge 2 | ret", result);
    check("charge 9 | add_i32 r0, r0, r0 | result_i32 r0 | ret", result);
}

#[test]
fn a_function_returns_what_its_signature_says() {
    check("charge 3 | ret_i32 r0", "word 14: the return is not that of the function's signature");
    check("charge 3 | add_i32 r0, r0, r0", "word 14: the function continues after its end");
    check("charge 3 | br_if r0, @13", "word 14: the function continues after its end");
    check("charge 4 | call_fw sig0, 0", "word 14: the function continues after its end");
    check("", "word 11: the function is empty");
}

#[test]
fn every_function_entry_and_loop_must_be_charged() {
    let uncharged = |at| format!("word {at}: the code from here on can run forever without being charged");
    check("ret", &uncharged(13));
    check("charge 0 | ret", &uncharged(13));
    check("charge 1 | ret", "ok");
    check("charge 9 | @up: add_i32_imm r0, r0, 1 | br @up", &uncharged(14));
    check("charge 9 | call_fw sig0, 0 | ret", "ok");
    check("charge 9 | br_if r0, @end | add_i32_imm r0, r0, 1 | @end: ret", "ok");
    check("charge 9 | @up: br_if r0, @end | charge 1 | br @up | @end: ret", "ok");
    check("charge 9 | @up: br_if r0, @end | br @up | charge 1 | @end: ret", &uncharged(14));
    check("charge 9 | @up: br_table r0, 1 | br @up | br @end | @end: ret", &uncharged(14));
}

#[test]
fn structural_words_must_be_in_order() {
    assert_eq!(message("sig 1, 9"), "word 11: a result class of 9 does not exist");
    assert_eq!(message("sig 1, 0"), "word 12: the text is truncated");
    assert_eq!(message("ret"), "word 11: `ret` is not allowed here");
    assert_eq!(message("func sig0, 1, 0\nret"), "word 12: `ret` is not allowed here");
    let wrong = "word 11: the function's first registers are not the parameters of its signature";
    assert_eq!(message("func sig1, 1, 0\ntypes 1\ncharge 2\nret"), wrong);
    check("charge 2 | types 0 | ret", "word 14: `types` is not allowed here");
    assert_eq!(message("word 0xffff"), "word 11: not an instruction");
}

#[test]
fn text_that_is_not_bytecode_is_refused_with_the_reason() {
    let check = |text: &[u8], expected: &str| {
        assert_eq!(verify(text, BASE).map_err(|error| error.to_string()), Err(expected.to_owned()));
    };
    check(&[], "word 0: the text is not bytecode");
    check(&[1; 8], "word 0: the text is not bytecode");
    check(&[0; 9], "word 1: the text does not consist of whole words of 8 bytes at a multiple of 8");
    check(
        &[0, 0, 7, 0, 0, 0, 0, 0],
        "word 0: the text is bytecode of version 7, this machine runs version 1",
    );
    check(&[0, 0, 1, 0, 9, 0, 0, 0], "word 1: the text is truncated");
}

proptest! {
    #[test]
    fn random_bytes_never_panic(text in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = verify(&text, BASE);
    }

    #[test]
    fn damaged_programs_never_panic(at in 0..200_usize, with: [u8; 8], cut in 0..200_usize) {
        let mut text = bytes(
            "@main: func sig0, 4, 1\ntypes 0xd0\n@up: charge 20\narg_i32 r0, 0\ncall fn@inc\nresult_i32 r0\n\
             charge 5\nbr_table r0, 1\nbr @up\nbr @end\n@end: charge 2\nret\n\
             @inc: func sig3, 1, 0\ntypes 0\ncharge 3\nadd_i32_imm r0, r0, 1\nret_i32 r0\n",
        );
        let words = text.len() / WORD;
        let at = (HEAD_WORDS + at % (words - HEAD_WORDS)) * WORD;
        text[at..at + WORD].copy_from_slice(&with);
        let _ = verify(&text, BASE);
        text.truncate(cut * WORD);
        let _ = verify(&text, BASE);
    }
}
