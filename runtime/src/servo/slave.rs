//! Slaved axes: their destination changes with their master's.

use kmotiondef::modes::OutputMode;
use kmotiondef::structs::Chan;
use kmotiondef::{Axes, AxisId};
use vm::memory::GuestMemory;

use super::state::Servo;
use crate::views::TypedAccess;

/// Applies the changes of all masters in this tick, whatever their cause.
pub(crate) fn follow(servo: &Servo, memory: &mut GuestMemory) {
    let mut moved = [None; Axes::MAX];
    for axis in memory.axes().iter() {
        change(servo, memory, axis, &mut moved, memory.axes().count());
    }
}

/// The change of an axis' command in this tick, after its own master's; at most `depth` axes in a chain.
fn change(
    servo: &Servo,
    memory: &mut GuestMemory,
    axis: AxisId,
    moved: &mut [Option<f64>; Axes::MAX],
    depth: usize,
) -> f64 {
    if let Some(change) = moved[axis.index()] {
        return change;
    }
    let is_enabled = memory.axis(axis, Chan::ENABLE) != 0;
    let master = memory.axes().get(memory.axis(axis, Chan::MASTER_AXIS)).filter(|_| is_enabled && depth > 0);
    if let Some(master) = master {
        let moved = change(servo, memory, master, moved, depth - 1);
        // Its own motion does not include this change: in the next tick the slave is at the position of that motion,
        // and changes by that tick only.
        if moved != 0.0 {
            let dest = memory.axis(axis, Chan::DEST) + memory.axis(axis, Chan::SLAVE_GAIN) * moved;
            memory.set_axis(axis, Chan::DEST, dest);
        }
    }
    let change = if is_enabled { own_change(servo, memory, axis) } else { 0.0 };
    moved[axis.index()] = Some(change);
    change
}

/// The change of the destination since the last tick; for a closed-loop stepper, also that of its output.
fn own_change(servo: &Servo, memory: &GuestMemory, axis: AxisId) -> f64 {
    let change = memory.axis(axis, Chan::DEST) - servo.axes[axis.index()].dest;
    let mode = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE));
    if mode.is_some_and(|mode| mode.traits().corrects_command) {
        return change + f64::from(memory.axis(axis, Chan::OUTPUT) - memory.axis(axis, Chan::PREV_OUTPUT));
    }
    change
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TestBench;

    #[test]
    fn a_chain_of_slaves_follows_in_the_same_tick() {
        // `checks.jsonl`, "chain of slaves 0 -> 1 (0.5) -> 2 (2.0), master Dest written".
        let mut bench = TestBench::new();
        let [a, b, c] = [0, 1, 2].map(|axis| AxisId::new(axis).expect("an axis"));
        for axis in [a, b, c] {
            bench.call("EnableAxisDest", &[axis.index() as u64, 0]);
        }
        bench.memory.set_axis(b, Chan::MASTER_AXIS, 0);
        bench.memory.set_axis(b, Chan::SLAVE_GAIN, 0.5);
        bench.memory.set_axis(c, Chan::MASTER_AXIS, 1);
        bench.memory.set_axis(c, Chan::SLAVE_GAIN, 2.0);
        for (dest, expect) in
            [(0.0, [0.0; 3]), (1.0, [1.0, 0.5, 1.0]), (3.0, [3.0, 1.5, 3.0]), (3.0, [3.0, 1.5, 3.0])]
        {
            bench.memory.set_axis(a, Chan::DEST, dest);
            bench.run(1);
            assert_eq!([a, b, c].map(|axis| bench.memory.axis(axis, Chan::DEST)), expect);
        }
    }
}
