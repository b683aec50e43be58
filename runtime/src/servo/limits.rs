//! Protection: limit switches, soft limits, following error. Source: axes-and-motion.md section 7.

use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::variables::CS0_STOPPING_STATE;
use kmotiondef::{AxisId, Bit, Field};
use vm::memory::GuestMemory;

use super::coordinated::system::is_member;
use super::hold;
use super::plan::AxisPlan;
use super::state::{AxisMemory, Servo, Tick};
use super::stop::StopReport;
use super::switching::switch_off;
use crate::io::Io;
use crate::io::bits::bit_state;
use crate::machine::Channel;
use crate::machine::wiring::channel_of;
use crate::out::{Message, Out};
use crate::views::{AxisView, TypedAccess};

/// `LimitSwitchOptions`: take the bit numbers from their own fields.
const EXTENDED: i32 = 1 << 8;

/// The effect of an active limit switch.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Action {
    /// Disables the axis.
    Kill,
    /// Disable the axis when it is driven into the limit.
    Disallow,
    /// Begins a feedhold when the axis is driven into the limit.
    Stop,
}

/// One end of an axis' travel.
struct End {
    name: &'static str,
    direction: i32,
    /// The bit of `LimitSwitchOptions` that enables the watch; the polarity is two bits higher.
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

/// Returns whether a limit switch is watched or a soft limit is passed: only then can [`check`] have an effect.
#[inline(always)]
pub(crate) fn may_act(chan: &AxisView<'_>, plan: &AxisPlan) -> bool {
    let dest = chan.get(Chan::DEST);
    plan.watches_switches || dest > plan.soft_limit_pos || dest < plan.soft_limit_neg
}

/// Notes the following error of a closed-loop axis; returns whether it is too large.
#[inline(always)]
pub(crate) fn follows_badly(chan: &mut AxisView<'_>, plan: &AxisPlan, command: f64) -> bool {
    let error = f64::from((command - chan.get(Chan::POSITION)) as f32);
    chan.set(Chan::LAST_FOLLOWING_ERROR, error);
    error.abs() > plan.max_following_error
}

/// Checks both ends of an enabled axis and, in a closed loop, its following error; returns whether it is still enabled.
pub(crate) fn check(
    tick: &mut Tick<'_>,
    memory: &mut GuestMemory,
    axis: AxisId,
    command: Option<f64>,
) -> bool {
    for end in &ENDS {
        check_switch(tick, memory, axis, end);
        check_soft(tick, memory, axis, end);
    }
    let plan = tick.servo.cache.plan(axis);
    if command.is_some_and(|command| follows_badly(&mut AxisView::of(memory, axis), plan, command)) {
        let own = tick.servo.axes[axis.index()];
        let known = amplifier_off(tick, memory, axis);
        let known = known.or_else(|| scale(tick, memory, axis, &own));
        // An axis at the end of its travel cannot follow, which has already been reported.
        if let Some(message) =
            known.or_else(|| following_error_cause(tick, memory, axis, &own)).filter(|_| !own.is_explained)
        {
            tick.remark_on_axis(memory, axis, message);
        }
        report_disabled(tick, &format!("Following Error Disabled Axis:{axis}"));
        switch_off(tick.servo, tick.machine, memory, axis);
        hold::abort_if_member(memory, axis);
    }
    memory.axis(axis, Chan::ENABLE) != 0
}

/// An amplifier that has switched itself off.
fn amplifier_off(tick: &Tick<'_>, memory: &GuestMemory, axis: AxisId) -> Option<Message> {
    let Some(Channel::Pwm(channel)) = channel_of(memory, axis) else { return None };
    let (board, cause) = tick.io.snapamps.cause(channel as i32, tick.now)?;
    Some(Message::BridgesOff { axis, board, cause })
}

/// A scale or sign of the position that does not match a load that goes where it is commanded: for such a load the
/// output is not significant.
fn scale(tick: &Tick<'_>, memory: &GuestMemory, axis: AxisId, own: &AxisMemory) -> Option<Message> {
    /// Commanded units from which the motion shows it.
    const ENOUGH: f64 = 20.0;
    /// The part of the error by which the load itself may lag.
    const LAG: f64 = 0.2;
    /// The fraction of the distance that counts as motion, and a relative difference of scales.
    const LEAST: f64 = 0.02;
    const DIFFERENCE: f64 = 0.1;
    let error = memory.axis(axis, Chan::LAST_FOLLOWING_ERROR);
    let is_encoder = memory.axis(axis, Chan::INPUT_MODE) == InputMode::Encoder.get();
    let rest = tick.machine.loads[axis].rest()?;
    if !is_encoder || rest.abs() > LAG * error.abs() || own.commanded < ENOUGH {
        return None;
    }
    let ratio = own.followed / own.commanded;
    if ratio < -LEAST {
        return Some(Message::RunsAway { axis });
    }
    let gain = memory.axis(axis, Chan::INPUT_GAIN0);
    let is_wrong = ratio > LEAST && (ratio - 1.0).abs() > DIFFERENCE;
    is_wrong.then(|| Message::ScaleWrong { axis, ratio, gain, right: f64::from(gain) / ratio })
}

/// Returns the cause of an excessive following error, as far as the servo has seen it since the axis was enabled.
fn following_error_cause(
    tick: &Tick<'_>,
    memory: &GuestMemory,
    axis: AxisId,
    own: &AxisMemory,
) -> Option<Message> {
    /// A part of the error that disables the axis.
    const SWINGS: f64 = 0.3;
    /// Changes that no motion needs.
    const MANY_FLIPS: u32 = 20;
    let AxisMemory { response, ahead, flips, .. } = *own;
    let error = memory.axis(axis, Chan::LAST_FOLLOWING_ERROR);
    let (output, velocity) = (memory.axis(axis, Chan::OUTPUT), memory.axis(axis, Chan::LAST_VEL));
    let most = memory.axis(axis, Chan::MAX_OUTPUT);
    let drives = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE)) != Some(OutputMode::None);
    let is_encoder = memory.axis(axis, Chan::INPUT_MODE) == InputMode::Encoder.get();
    if output == 0.0 || !drives || !is_encoder {
        return None;
    }
    if response < 0.0 {
        let is_driven = tick.machine.loads[axis].rest().is_none();
        return is_driven.then_some(Message::RunsAway { axis });
    }
    if response == 0.0 {
        // Less than one count of the output moves nothing, and few amplifiers move their motor at a few counts.
        const WEAK: f32 = 0.02;
        let p = memory.axis(axis, Chan::P);
        let is_weak = output.abs() < WEAK * most || output.abs() < 1.0;
        return Some(match is_weak {
            true => Message::WeakOutput { axis, output: f64::from(output), most, p },
            false => Message::NoResponse { axis, output },
        });
    }
    if flips > MANY_FLIPS {
        return Some(Message::Chatters { axis, times: flips });
    }
    // The axis falls behind a destination that moves on in the direction of the error, unless it swings around it.
    let swings = ahead > SWINGS * error.abs();
    if f64::from(velocity) * error > 0.0 && !swings {
        let is_at_limit = output.abs() >= most;
        return Some(if is_at_limit {
            Message::OutputLimit { axis, most }
        } else {
            lag_message(memory, axis)
        });
    }
    let cause = match memory.axis(axis, Chan::I) {
        0.0 => "the loop swings, so lower P or raise D",
        _ => "its integrator collects too much on the way, so lower I or MaxI, or raise D",
    };
    Some(Message::Overshoots { axis, cause })
}

fn lag_message(memory: &GuestMemory, axis: AxisId) -> Message {
    Message::Lags { axis, most: f64::from_bits(memory.axis(axis, Chan::MAX_FOLLOWING_ERROR).to_bits()) }
}

/// Says that an axis was disabled, unless another message waits for the primary thread.
fn report_disabled(tick: &mut Tick<'_>, text: &str) {
    if !tick.servo.stop_request.is_asked() {
        tick.out.console.servo_message(text);
    }
}

/// Returns whether the switch of an end is watched and active.
fn is_active(tick: &Tick<'_>, memory: &GuestMemory, axis: AxisId, end: &End) -> bool {
    active_bit(tick.io, memory, axis, end).is_some()
}

/// A limit switch of an axis that is watched and active.
pub(crate) fn active_switch(io: &Io, memory: &GuestMemory, axis: AxisId) -> Option<Bit> {
    ENDS.iter().find_map(|end| active_bit(io, memory, axis, end))
}

/// The switch of an end, if it is watched.
fn watched_bit(memory: &GuestMemory, axis: AxisId, end: &End) -> Option<Bit> {
    let options = memory.axis(axis, Chan::LIMIT_SWITCH_OPTIONS);
    if options >> end.watch & 1 == 0 {
        return None;
    }
    let number =
        if options & EXTENDED != 0 { memory.axis(axis, end.bit) } else { options >> end.packed_shift & 0xff };
    Bit::new(number)
}

/// The switch of an end, if it is watched and active.
fn active_bit(io: &Io, memory: &GuestMemory, axis: AxisId, end: &End) -> Option<Bit> {
    let bit = watched_bit(memory, axis, end)?;
    let is_active_low = memory.axis(axis, Chan::LIMIT_SWITCH_OPTIONS) >> (end.watch + 2) & 1 != 0;
    (bit_state(io, memory, bit).0 != is_active_low).then_some(bit)
}

/// A limit switch that is watched.
pub(crate) struct WatchedLimit {
    /// `Neg` or `Pos`.
    pub(crate) end: &'static str,
    pub(crate) bit: Bit,
    /// The number in the field of the end, used or not.
    pub(crate) field: i32,
    /// True if that is used.
    pub(crate) is_extended: bool,
    /// The level that counts as active.
    pub(crate) active: bool,
    /// The bit of `LimitSwitchOptions` that selects it.
    pub(crate) polarity: u32,
    /// True at the end where Dest is high.
    pub(crate) is_upper: bool,
}

/// The limit switches of an axis that are watched.
pub(crate) fn watched_limits(memory: &GuestMemory, axis: AxisId) -> Vec<WatchedLimit> {
    let options = memory.axis(axis, Chan::LIMIT_SWITCH_OPTIONS);
    let limit = |end: &End| {
        let polarity = end.watch + 2;
        Some(WatchedLimit {
            end: end.name,
            bit: watched_bit(memory, axis, end)?,
            field: memory.axis(axis, end.bit),
            is_extended: options & EXTENDED != 0,
            active: options >> polarity & 1 == 0,
            polarity,
            is_upper: end.direction > 0,
        })
    };
    ENDS.iter().filter_map(limit).collect()
}

/// The limit switches that have a number and are not watched, each with its end.
pub(crate) fn unwatched_limits(memory: &GuestMemory, axis: AxisId) -> Vec<(&'static str, Bit)> {
    let options = memory.axis(axis, Chan::LIMIT_SWITCH_OPTIONS);
    let unwatched = ENDS.iter().filter(|end| options >> end.watch & 1 == 0);
    let number = |end: &End| Bit::new(memory.axis(axis, end.bit)).filter(|bit| bit.get() > 0);
    unwatched.filter_map(|end| Some((end.name, number(end)?))).collect()
}

fn check_switch(tick: &mut Tick<'_>, memory: &mut GuestMemory, axis: AxisId, end: &End) {
    if !is_active(tick, memory, axis, end) {
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
        // Nothing stops an axis outside of the coordinate system, and nothing is reported.
        if !is_member(memory, axis) {
            return;
        }
        return tick.servo.stop_request.ask(format!("{} Limit Stop Axis:{axis}", end.name), StopReport::Stop);
    }
    report_disabled(tick, &format!("{} Limit Disabled Axis:{axis}", end.name));
    switch_off(tick.servo, tick.machine, memory, axis);
    hold::abort_if_member(memory, axis);
}

fn check_soft(tick: &mut Tick<'_>, memory: &GuestMemory, axis: AxisId, end: &End) {
    let direction = f64::from(end.direction);
    let beyond = (memory.axis(axis, Chan::DEST) - f64::from(memory.axis(axis, end.soft))) * direction > 0.0;
    let goes_there = memory.axis(axis, Chan::DIRECTION_OF_MOTION) == end.direction;
    if !beyond || !goes_there || memory.get(CS0_STOPPING_STATE) != 0 {
        return;
    }
    let text = format!("{} Soft Limit FeedHold Axis:{axis}", end.name);
    tick.servo.stop_request.ask(text, StopReport::Always);
}

/// Acts on the limits in the primary thread's slice; returns whether a stop was tried.
pub(crate) fn slice(servo: &mut Servo, out: &mut Out, memory: &mut GuestMemory) -> bool {
    if hold::stop_next(servo, memory) {
        return true;
    }
    if !servo.stop_request.is_asked() {
        return false;
    }
    if servo.stop_request.is_new() {
        hold::prepare_stop(memory);
        return false;
    }
    let asked = servo.stop_request.take();
    if memory.get(CS0_STOPPING_STATE) != 0 {
        return false;
    }
    let stops = hold::begin(servo, memory);
    let is_told = |tells| match tells {
        StopReport::Stop => stops,
        StopReport::Always => true,
        StopReport::Never => false,
    };
    if let Some((text, _)) = asked.filter(|(_, tells)| is_told(*tells)) {
        out.console.message(&text);
    }
    true
}

#[cfg(test)]
mod tests {
    use kmotiondef::variables::VIRTUAL_BITS;

    use super::*;
    use crate::testing::TestBench;

    fn axis() -> AxisId {
        AxisId::new(0).expect("0 is an axis")
    }

    #[test]
    fn an_error_at_the_limit_is_allowed() {
        // `servo.jsonl`, "following error, output mode 0".
        let mut bench = TestBench::new();
        bench.memory.set_axis(axis(), Chan::MAX_FOLLOWING_ERROR, 10.0);
        bench.call("EnableAxisDest", &[0, 0]);
        for (dest, enabled) in [(5.0, 1), (10.0, 1), (10.001, 0), (0.0, 0)] {
            bench.memory.set_axis(axis(), Chan::DEST, dest);
            bench.run(1);
            assert_eq!(bench.memory.axis(axis(), Chan::ENABLE), enabled, "{dest}");
        }
        assert_eq!(bench.memory.axis(axis(), Chan::OUTPUT), 10.0);
        assert_eq!(bench.printed(), ["Following Error Disabled Axis:0"]);
    }

    #[test]
    fn packed_limit_bit_numbers_disable_the_axis() {
        // `servo.jsonl`, "limit bits packed in the option word".
        let mut bench = TestBench::new();
        bench.memory.set_axis(axis(), Chan::LIMIT_SWITCH_OPTIONS, 825_229_315);
        bench.call("EnableAxisDest", &[0, 0]);
        bench.run(2);
        assert_eq!(bench.memory.axis(axis(), Chan::ENABLE), 1);
        bench.memory.set(VIRTUAL_BITS, 1);
        bench.run(1);
        assert_eq!(bench.memory.axis(axis(), Chan::ENABLE), 0);
        assert_eq!(bench.printed(), ["Neg Limit Disabled Axis:0"]);
    }

    #[test]
    fn a_soft_limit_stops_an_axis_and_reports_once() {
        let mut bench = TestBench::new();
        for axis in 0..4 {
            bench.call("EnableAxisDest", &[axis, 0]);
        }
        bench.memory.set_axis(axis(), Chan::SOFT_LIMIT_POS, 5.0);
        bench.call_in_slices("Move", &[0, 100.0_f64.to_bits()]);
        bench.run(20_000);
        assert!(!crate::servo::independent::has_motion(&bench.memory, axis()));
        let dest = bench.memory.axis(axis(), Chan::DEST);
        assert!(dest > 5.0 && dest < 100.0, "{dest}");
        assert_eq!(bench.printed(), ["Pos Soft Limit FeedHold Axis:0"]);
    }
}
