//! What functions that wait still do when the wait has ended, as the board does (costs.md section 3).
//!
//! The table's cost is spent when the call is made; what is spent after the wait depends on why it waited.

use kmotiondef::Cycles;
use kmotiondef::timing::WaitStates;
use vm::wake::Wake;

/// What a function spends after its wait, by its name in the runtime.
///
/// Moves that are called in motion are planned when the next slice begins; the time functions look at the clock again.
pub(crate) fn after(function: &str, wake: Wake, waits: WaitStates) -> Cycles {
    let accesses = |count: u32| i64::from(count * waits.register);
    Cycles::new(match (function, wake) {
        ("wait_next_time_slice", _) => 69 + accesses(1),
        ("delay_sec" | "wait_until", Wake::At(_)) => 63 + accesses(1),
        ("move_to" | "move_rel" | "move_at_vel" | "move_rel_at_vel", Wake::NextSlice) => 4720,
        ("jog", Wake::NextSlice) => 1500,
        ("move_xyzabc", Wake::NextSlice) => 3475,
        _ => 0,
    })
}
