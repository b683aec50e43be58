//! The work of waiting functions after their wait, and the work of the primary thread meanwhile, as on the board
//! (costs.md sections 3 and 5).
//!
//! The cost in the table is spent when the call is made; the cost after the wait depends on the reason for the wait.

use kmotiondef::Cycles;
use kmotiondef::firmware::FirmwareFunction;
use kmotiondef::function::WaitEnd;
use kmotiondef::timing::WaitStates;
use vm::wake::Wake;

/// The time that a function spends after its wait.
///
/// Moves that are called in motion are planned when the next slice begins; the time functions read the clock again.
pub(crate) fn after(function: &FirmwareFunction, wake: Wake, waits: WaitStates) -> Cycles {
    let has_ended = |event| match event {
        WaitEnd::Slice => matches!(wake, Wake::NextSlice),
        WaitEnd::Time => matches!(wake, Wake::At(_)),
    };
    function.attributes.resumption.filter(|resumption| has_ended(resumption.event)).map_or(
        Cycles::default(),
        |resumption| {
            resumption.cycles + Cycles::new(i64::from(resumption.register_accesses * waits.register))
        },
    )
}

/// Returns the time that the primary thread takes to send a console line of `characters`.
pub(crate) fn sending(characters: usize, waits: WaitStates) -> Cycles {
    let n = i64::try_from(characters).unwrap_or(i64::MAX / 1000);
    let (cycles, accesses, words) = (248 + 79 * n, 5 + 2 * n, 4 + 3 * n);
    Cycles::new(cycles + accesses * i64::from(waits.register) + words * i64::from(waits.sdram))
}

#[cfg(test)]
mod tests {
    use serde_json::Value as Json;

    use super::*;
    use crate::text::vectors::rows;

    #[test]
    fn a_console_line_costs_the_primary_thread_what_was_measured() {
        let mut compared = 0;
        for row in rows("costs.jsonl") {
            let Some(length) = row["what"].as_str().and_then(|what| what.strip_prefix("console line of "))
            else {
                continue;
            };
            let length = length.split(' ').next().and_then(|length| length.parse().ok()).expect("a number");
            let settings = [WaitStates::NONE, WaitStates::REGISTERS, WaitStates { register: 44, sdram: 20 }];
            let found = settings.map(|waits| Json::from(sending(length, waits).get()));
            assert_eq!(Json::from(found.to_vec()), row["cycles"], "{length}");
            compared += 1;
        }
        assert_eq!(compared, 4);
    }
}
