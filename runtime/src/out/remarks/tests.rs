//! Tests of the table of remarks.

use std::collections::BTreeSet;

use super::*;

#[test]
fn codes_are_lower_case_words_and_unique() {
    let codes: BTreeSet<_> = REMARKS.iter().map(|row| row.code).collect();
    assert_eq!(codes.len(), REMARKS.len());
    for code in codes {
        assert!(
            code.bytes().all(|byte| byte.is_ascii_lowercase() || b"-0123456789".contains(&byte)),
            "{code}"
        );
    }
}

#[test]
fn a_remark_says_who_and_what() {
    let message = Message::NoSuchBit { function: Function::SetBit, bit: 3000 };
    assert_eq!(message.arguments(), [("function", "SetBit".to_owned()), ("bit", "3000".to_owned())]);
    let speaker = Speaker::Thread(ThreadId::new(1).expect("1 is a thread"));
    let remark = Remark { message, speaker, place: None };
    assert_eq!(remark.to_string(), "thread 1: SetBit(3000): no such bit (0-2047)");
}
