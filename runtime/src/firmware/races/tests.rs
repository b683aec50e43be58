//! Short sequences of accesses: the losses among them are found, the patterns of real programs are not.

use vm::firmware::SharedAccess;

use super::*;

/// Accesses of threads 1 and 2, one a word: `1l5` loads element 5, `1u5` loads and stores it, `1s5=3` stores 3, `1L9`
/// and `1U9` lock and unlock element 9. A place is the number of the word.
fn codes(steps: &str) -> Vec<&'static str> {
    let (mut races, mut out, memory) = (Races::default(), Out::default(), GuestMemory::new());
    let threads = Threads::new();
    for number in [1, 2] {
        races.begin_thread(ThreadId::new(number).expect("it is a thread"), &threads, Cycles::default());
    }
    for (number, step) in (0..).zip(steps.split_whitespace()) {
        let thread = ThreadId::new(i32::from(step.as_bytes()[0] - b'0'));
        let (element, value) = step[2..].split_once('=').unwrap_or((&step[2..], "0"));
        let (element, value): (usize, u64) =
            (element.parse().expect("a number"), value.parse().expect("one"));
        let place = PERSIST.field(Persist::USER_DATA).element(element).address();
        // The same step is at the same place each time.
        let word = steps.split_whitespace().position(|other| other == step).unwrap_or(0) as u32;
        let at = |part: u32| CodeAddr::new(0x8005_0000 + 16 * word + 4 * part).expect("it is aligned");
        let now = Cycles::new(100 * number);
        let made_of = [at(0)];
        let access = |is_store, made_of| {
            let at = if is_store { at(1) } else { at(0) };
            SharedAccess { thread, at, address: place, size: 4, is_store, value, made_of, now }
        };
        let actor = Actor { thread, at: at(0), now };
        let mut accessed = |access| {
            races.record_access(&access, &memory, &mut out);
        };
        match step.as_bytes()[1] {
            b'l' => accessed(access(false, &[])),
            b's' => accessed(access(true, &[])),
            b'u' => {
                accessed(access(false, &[]));
                accessed(access(true, &made_of));
            }
            b'L' => races.locks(actor, place, true, &mut out),
            b'U' => races.record_unlock(actor, place),
            b'A' => races.changed_at_once(actor, place, 1, &mut out),
            other => panic!("{other}"),
        }
    }
    races.finish(&threads, Cycles::default(), &mut out);
    let code = |event: crate::out::Event| match event.kind {
        crate::out::EventKind::Remark(remark) => remark.message.code(),
        other => panic!("{other:?}"),
    };
    out.take_events().into_iter().map(code).collect()
}

#[test]
fn losses_are_found_and_patterns_are_not() {
    for (steps, expected) in [
        // Two counters; a counter under a lock, and once without.
        ("1u5 2u5", &["race-update"][..]),
        ("1u5 1u5 2u5 2u5 1u5", &["race-update"]),
        ("1L9 1u5 1U9 2L9 2u5 2U9", &[]),
        ("1L9 1u5 1U9 2u5", &["race-update"]),
        ("1L9 1u5 1U9 2L8 2u5 2U8", &["race-update"]),
        // One writer, a reader; a counter and a bit set at once.
        ("1u5 2l5 1u5 2l5", &[]),
        ("1s5=1 2l5=1 1s5=2 2l5=2", &[]),
        ("1u5 2A5", &["race-store"]),
        // In turns, by a flag.
        ("1u5 1s6=1 2l6=1 2u5 2s6=2 1l6=2 1u5", &[]),
        ("1s6=1 1u5 2l6=1 2u5", &["race-update"]),
        // A request that one sets and the other clears; a cell that both take.
        ("1l5=0 1s5=3 2l5=3 2s5=0 1l5=0 1s5=4 2l5=4 2s5=0", &[]),
        ("1l5=0 1s5=1 2l5=0 2s5=2", &["race-claim"]),
        ("1l5=0 1s5=1 2l5=0 2s5=1", &[]),
        ("1l5=0 1s5=1 1s5=0 2l5=0 2s5=1", &["race-claim"]),
        // Locks.
        ("1L8 1L9 1U9 1U8 2L9 2L8 2U8 2U9", &["lock-order"]),
        ("1L8 1L9 1U9 1U8 2L8 2L9 2U9 2U8", &[]),
        ("1L8", &["lock-kept"]),
        // An order before its parameter, and after it.
        ("1s5=1 1s6=7 2l5=1 2l6=7 2s5=0 1l5=0 1s5=1 1s6=7 2l5=1 2l6=7 2s5=0", &["order-early"]),
        ("1s6=7 1s5=1 2l5=1 2l6=7 2s5=0 1l5=0 1s6=7 1s5=1 2l5=1 2l6=7 2s5=0", &[]),
        // Two programs that ask the PC.
        ("1s100=2 2s100=3", &["race-request"]),
    ] {
        assert_eq!(codes(steps), expected, "{steps}");
    }
}
