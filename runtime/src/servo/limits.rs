//! Protection: limit switches, soft limits, following error. Source: axes-and-motion.md section 7.

use kmotiondef::structs::Chan;
use kmotiondef::variables::CS0_STOPPING_STATE;
use kmotiondef::{AxisId, Bit, Field};
use vm::memory::GuestMemory;

use super::plan::Plan;
use super::switch_off;
use crate::firmware::coord;
use crate::firmware::io::bit_state;
use crate::kernel::Kernel;
use crate::views::{AxisView, Typed};

/// `LimitSwitchOptions`: take the bit numbers from their own fields.
const EXTENDED: i32 = 1 << 8;

/// What an active limit switch does.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Action {
    /// Disables the axis.
    Kill,
    /// Disables the axis when it is driven into the limit.
    Disallow,
    /// Begins a feedhold when the axis is driven into the limit.
    Stop,
}

/// One end of an axis' travel.
struct End {
    name: &'static str,
    direction: i32,
    /// Bit of `LimitSwitchOptions` that watches it; the polarity is two bits further.
    watch: u32,
    packed_shift: u32,
    bit: Field<i32>,
    soft: Field<f32>,
}

const ENDS: [End; 2] = [
    End {
        name: "Neg",
        direction: -1,
        watch: 0,
        packed_shift: 16,
        bit: Chan::LIMIT_SWITCH_NEG_BIT,
        soft: Chan::SOFT_LIMIT_NEG,
    },
    End {
        name: "Pos",
        direction: 1,
        watch: 1,
        packed_shift: 24,
        bit: Chan::LIMIT_SWITCH_POS_BIT,
        soft: Chan::SOFT_LIMIT_POS,
    },
];

/// Whether an axis watches a limit switch.
pub(crate) fn watches_switches(chan: &AxisView<'_>) -> bool {
    const WATCHED: i32 = 3;
    chan.get(Chan::LIMIT_SWITCH_OPTIONS) & WATCHED != 0
}

/// Whether a limit switch is watched or a soft limit is passed: only then [`check`] can do anything.
#[inline(always)]
pub(crate) fn may_act(chan: &AxisView<'_>, plan: &Plan) -> bool {
    let dest = chan.get(Chan::DEST);
    plan.watches_switches || dest > plan.soft_limit_pos || dest < plan.soft_limit_neg
}

/// Notes the following error of an axis in a closed loop; whether it is too large.
#[inline(always)]
pub(crate) fn follows_badly(chan: &mut AxisView<'_>, plan: &Plan, command: f64) -> bool {
    let error = f64::from((command - chan.get(Chan::POSITION)) as f32);
    chan.set(Chan::LAST_FOLLOWING_ERROR, error);
    error.abs() > plan.max_following_error
}

/// Checks both ends of an enabled axis and, in a closed loop, whether it follows its command; whether it is enabled
/// still.
pub(crate) fn check(
    kernel: &mut Kernel,
    memory: &mut GuestMemory,
    axis: AxisId,
    command: Option<f64>,
) -> bool {
    for end in &ENDS {
        check_switch(kernel, memory, axis, end);
        check_soft(kernel, memory, axis, end);
    }
    let plan = &kernel.servo.plans[axis.index()];
    if command.is_some_and(|command| follows_badly(&mut AxisView::of(memory, axis), plan, command)) {
        kernel.console.message(&format!("Following Error Disabled Axis:{axis}"));
        switch_off(kernel, memory, axis);
        coord::abort_if_member(memory, axis);
    }
    memory.axis(axis, Chan::ENABLE) != 0
}

/// Whether the switch of an end is watched and active.
fn is_active(kernel: &Kernel, memory: &GuestMemory, axis: AxisId, end: &End) -> bool {
    let options = memory.axis(axis, Chan::LIMIT_SWITCH_OPTIONS);
    if options >> end.watch & 1 == 0 {
        return false;
    }
    let number =
        if options & EXTENDED != 0 { memory.axis(axis, end.bit) } else { options >> end.packed_shift & 0xff };
    let is_active_low = options >> (end.watch + 2) & 1 != 0;
    Bit::new(number).is_some_and(|bit| bit_state(kernel, memory, bit).0 != is_active_low)
}

fn check_switch(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId, end: &End) {
    if !is_active(kernel, memory, axis, end) {
        return;
    }
    let action = match memory.axis(axis, Chan::LIMIT_SWITCH_OPTIONS) >> 4 & 0xf {
        0 => Action::Kill,
        1 => Action::Disallow,
        _ => Action::Stop,
    };
    let goes_there = memory.axis(axis, Chan::DIRECTION_OF_MOTION) == end.direction;
    if action != Action::Kill && !goes_there {
        return;
    }
    if action == Action::Stop {
        // Nothing stops an axis outside the coordinate system, and nothing says so.
        if !coord::is_member(memory, axis) {
            return;
        }
        return kernel.servo.stop_request.ask(format!("{} Limit Stop Axis:{axis}", end.name), Tells::Stop);
    }
    kernel.console.message(&format!("{} Limit Disabled Axis:{axis}", end.name));
    switch_off(kernel, memory, axis);
}

fn check_soft(kernel: &mut Kernel, memory: &GuestMemory, axis: AxisId, end: &End) {
    let direction = f64::from(end.direction);
    let beyond = (memory.axis(axis, Chan::DEST) - f64::from(memory.axis(axis, end.soft))) * direction > 0.0;
    let goes_there = memory.axis(axis, Chan::DIRECTION_OF_MOTION) == end.direction;
    if !beyond || !goes_there || memory.get(CS0_STOPPING_STATE) != 0 {
        return;
    }
    let text = format!("{} Soft Limit FeedHold Axis:{axis}", end.name);
    kernel.servo.stop_request.ask(text, Tells::Always);
}

/// When the stop at a limit is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tells {
    /// If something was stopped.
    Stop,
    /// Whenever it was tried: again and again of an axis outside the coordinate system, which nothing stops.
    Always,
}

/// A feedhold that the servo asks the primary thread for.
#[derive(Clone, Debug, Default)]
pub(crate) struct StopRequest {
    asked: Option<(String, Tells)>,
    /// Whether the primary thread has seen it: computing the stop takes it until its next slice.
    is_seen: bool,
}

impl StopRequest {
    /// Asks, unless a stop is being computed.
    fn ask(&mut self, text: String, tells: Tells) {
        self.asked.get_or_insert((text, tells));
    }
}

/// What the primary thread does for the limits in its slice.
pub(crate) fn slice(kernel: &mut Kernel, memory: &mut GuestMemory) {
    let request = &mut kernel.servo.stop_request;
    if request.asked.is_none() {
        return;
    }
    if !request.is_seen {
        request.is_seen = true;
        return coord::prepare_stop(memory);
    }
    let asked = std::mem::take(request).asked;
    if memory.get(CS0_STOPPING_STATE) != 0 {
        return;
    }
    let stops = coord::stop(kernel, memory);
    if let Some((text, _)) = asked.filter(|(_, tells)| stops || *tells == Tells::Always) {
        kernel.console.message(&text);
    }
    kernel.disturb();
}

#[cfg(test)]
mod tests {
    use kmotiondef::variables::VIRTUAL_BITS;

    use super::*;
    use crate::testing::Desk;

    fn axis() -> AxisId {
        AxisId::new(0).expect("0 is an axis")
    }

    #[test]
    fn an_error_at_the_limit_is_allowed() {
        // `servo.jsonl`, "following error, output mode 0".
        let mut desk = Desk::new();
        desk.memory.set_axis(axis(), Chan::MAX_FOLLOWING_ERROR, 10.0);
        desk.call("EnableAxisDest", &[0, 0]);
        for (dest, enabled) in [(5.0, 1), (10.0, 1), (10.001, 0), (0.0, 0)] {
            desk.memory.set_axis(axis(), Chan::DEST, dest);
            desk.run(1);
            assert_eq!(desk.memory.axis(axis(), Chan::ENABLE), enabled, "{dest}");
        }
        assert_eq!(desk.memory.axis(axis(), Chan::OUTPUT), 10.0);
        assert_eq!(desk.printed(), ["Following Error Disabled Axis:0"]);
    }

    #[test]
    fn packed_bit_numbers_kill_the_axis() {
        // `servo.jsonl`, "limit bits packed in the option word".
        let mut desk = Desk::new();
        desk.memory.set_axis(axis(), Chan::LIMIT_SWITCH_OPTIONS, 825_229_315);
        desk.call("EnableAxisDest", &[0, 0]);
        desk.run(2);
        assert_eq!(desk.memory.axis(axis(), Chan::ENABLE), 1);
        desk.memory.set(VIRTUAL_BITS, 1);
        desk.run(1);
        assert_eq!(desk.memory.axis(axis(), Chan::ENABLE), 0);
        assert_eq!(desk.printed(), ["Neg Limit Disabled Axis:0"]);
    }

    #[test]
    fn a_soft_limit_holds_a_member_once() {
        let mut desk = Desk::new();
        for axis in 0..4 {
            desk.call("EnableAxisDest", &[axis, 0]);
        }
        desk.memory.set_axis(axis(), Chan::SOFT_LIMIT_POS, 5.0);
        desk.call_in_slices("Move", &[0, 100.0_f64.to_bits()]);
        desk.run(20_000);
        assert!(!super::super::independent::has_motion(&desk.memory, axis()));
        let dest = desk.memory.axis(axis(), Chan::DEST);
        assert!(dest > 5.0 && dest < 100.0, "{dest}");
        assert_eq!(desk.printed(), ["Pos Soft Limit FeedHold Axis:0"]);
    }
}
