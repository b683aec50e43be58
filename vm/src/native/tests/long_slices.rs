//! Many slices at once, compared with single ones.

use super::*;

/// The length of a slice with the servo time of the tests.
const SLICE: i64 = 10_000;

/// The machine with engine `E` after runs of these numbers of ticks.
fn run<E: Engine>(
    main: &str,
    pauses: &[u64],
    observe: &mut dyn FnMut(&Machine<Fake, E>),
) -> Machine<Fake, E> {
    let mut machine = machine_on::<E>(Config::default(), &[(1, main)]);
    for ticks in pauses {
        machine.run_until(Ticks::new(machine.tick().get() + ticks));
        observe(&machine);
    }
    machine
}

/// Checks that a program does the same on both engines, observed after each of `pauses`; returns the native machine.
fn check(main: &str, pauses: &[u64]) -> Machine<Fake, NativeEngine> {
    let mut steps = Vec::new();
    let mut places = Vec::new();
    let bytecode = run::<BytecodeEngine>(main, pauses, &mut |machine| {
        steps.push((machine.firmware().log.len(), machine.threads().clone()));
        places.push(machine.backtrace(thread(1)));
    });
    let mut at = 0;
    let native = run::<NativeEngine>(main, pauses, &mut |machine| {
        assert_eq!(steps[at], (machine.firmware().log.len(), machine.threads().clone()), "{main}");
        assert_eq!(places[at], machine.backtrace(thread(1)), "{main}");
        at += 1;
    });
    assert_same(&bytecode, &native);
    native
}

/// A program that repeats `steps`, each a kind and a number, until it divides by 0 if `ends`.
fn program_of(steps: &[(usize, i32)], ends: bool) -> String {
    let mut text = "@main: func sig0, 4, 8\ntypes 0\ncharge 9\nconst_i32 r2, 0x80f00000\n\
                    const_i32 r3, 0x10000040\nbr @again\n@again: "
        .to_owned();
    for (at, (kind, number)) in steps.iter().enumerate() {
        text += &match kind {
            // This number of cycles in iterations of 100, and a block of any length.
            0 => format!(
                "charge 9\nconst_i32 r0, {}\n@round{at}: charge 100\nload_i32 r1, r2, +8\nadd_i32_imm r1, r1, 1\n\
                 store_i32 r1, r2, +8\nadd_i32_imm r0, r0, -1\nbr_if r0, @round{at}\n",
                number + 1
            ),
            1 => format!("charge {}\nbr @next{at}\n@next{at}: ", number + 9),
            2 => "charge 40\nload_i32_at r1, 0x10000040\nadd_i32_imm r1, r1, 1\nstore_i32_at r1, 0x10000044\n\
                  br @next\n@next: "
                .replace("next", &format!("next{at}")),
            3 => "charge 40\nload_i32 r1, r3, +0\nadd_i32_imm r1, r1, 1\nstore_i32 r1, r3, +4\nbr @next\n@next: "
                .replace("next", &format!("next{at}")),
            4 => format!("charge 40\narg_i32 r1, 0\ncall_fw sig1, 0x10008000\ncharge 9\nbr @next{at}\n@next{at}: "),
            5 => format!(
                "charge 99\nconst_i32 r0, {}\narg_i32 r0, 0\ncall fn@f\nresult_i32 r0\ncharge 9\nbr @next{at}\n\
                 @next{at}: ",
                number % 300
            ),
            6 => format!("charge 99\ncopy r2, r3, 8\ncopy r2, r2, 8\nclear r3, 4\nbr @next{at}\n@next{at}: "),
            _ => format!("charge 99\nstore_i32_at r1, 0x80f00010\nload_i32_at r1, 0x80f00008\nbr @next{at}\n@next{at}: "),
        };
    }
    text += if ends {
        "charge 99\nconst_i32 r0, 0\ndiv_i32_s r0, r0, r0\nret\n"
    } else {
        "charge 99\nbr @again\n"
    };
    text + RECURSION
}

#[test]
fn a_block_that_ends_with_its_slice_belongs_to_it() {
    // Slices begin 8000 cycles after every second tick. The cycles before the note are those of three slices minus one,
    // of three slices, and of three slices plus one.
    for (cycles, expected) in [(29_999, "107999 1 0"), (30_000, "108000 1 0"), (30_001, "134001 1 0")] {
        let rest = cycles - 2 * (SLICE - 1) - 40 - 2;
        let main = format!(
            "@main: func sig0, 1, 0\ntypes 0\ncharge 2\nbr @a\n@a: charge {}\nbr @b\n@b: charge {}\nbr @c\n\
             @c: charge {rest}\nbr @d\n@d: charge 40\narg_i32 r0, 0\ncall_fw sig1, 0x10008000\ncharge 2\nret",
            SLICE - 1,
            SLICE - 1,
        );
        let native = check(&main, &[60]);
        assert_eq!(native.firmware().log, [expected], "{cycles}");
    }
}

#[test]
fn a_thread_that_is_alone_computes_many_ticks_at_once() {
    let main = program_of(&[(0, 90), (1, 400)], false);
    let native = check(&main, &[1, 2, 3, 700, 5]);
    assert!(native.firmware().skipped > 500, "{} ticks were skipped", native.firmware().skipped);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(60, 500)))]

    #[test]
    fn long_slices_change_no_result(
        steps in prop::collection::vec((0..8_usize, 0..9_000_i32), 1..8),
        pauses in prop::collection::vec(1..400_u64, 1..6),
        ends: bool,
    ) {
        let _ = check(&program_of(&steps, ends), &pauses);
    }
}
