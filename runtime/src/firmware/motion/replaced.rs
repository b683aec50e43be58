//! Motions that a thread replaces or ends before the axis has moved noticeably, or before it has arrived.
//!
//! A thread that has polled a bit or the axis since then had a reason; a thread that has only let a little time pass
//! probably meant to wait.

use kmotiondef::firmware::Function;
use kmotiondef::modes::LastMotion;
use kmotiondef::structs::Chan;
use kmotiondef::{AxisId, Cycles};
use vm::firmware::Caller;

use crate::firmware::calls::{CommandedMotion, MotionCall, Wait};
use crate::firmware::parts::Parts;
use crate::out::{Message, OtherPlace};
use crate::servo::independent::has_motion;
use crate::views::TypedAccess;

/// A thread that has polled the time more often waits for something.
const DELAYS: u32 = 3;
/// The fraction of the distance that may be left, or that is too short for a remark.
const REST: f64 = 0.01;
/// The time in which a thread has hardly waited: 50 ms.
const HARDLY: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 20);

/// A motion that the thread has begun and that is still in progress.
struct InterruptedMotion {
    called: MotionCall,
    dest: f64,
    is_at_start: bool,
    is_after_delay: bool,
}

/// A thread begins a motion of an axis: whether that replaces another one.
pub(super) fn check_begin(
    parts: &mut Parts,
    caller: &Caller<'_>,
    axis: AxisId,
    function: Function,
    motion: CommandedMotion,
) {
    let Some(InterruptedMotion { called, dest, is_at_start, is_after_delay }) =
        interrupted_motion(parts, caller, axis, Some(motion))
    else {
        return;
    };
    let message = match (called.motion, motion) {
        _ if !is_at_start && !is_after_delay => return,
        (
            CommandedMotion::Move(earlier) | CommandedMotion::MoveRel(_, earlier),
            CommandedMotion::MoveRel(way, target),
        ) if is_at_start => {
            let [earlier, way, dest, target] = [earlier, way, dest, target].map(round_to_thousandths);
            Message::RelativeReplaced { function, axis, earlier, way, dest, target }
        }
        (
            CommandedMotion::Move(earlier) | CommandedMotion::MoveRel(_, earlier),
            CommandedMotion::Move(target),
        ) if is_at_start && earlier != target => {
            let effect = format!("replaced by one to {}", round_to_thousandths(target));
            Message::MoveReplaced { function, axis, earlier: round_to_thousandths(earlier), effect }
        }
        (CommandedMotion::Move(earlier) | CommandedMotion::MoveRel(_, earlier), CommandedMotion::Jog(_))
            if is_at_start =>
        {
            let effect = "replaced by a jog".to_owned();
            Message::MoveReplaced { function, axis, earlier: round_to_thousandths(earlier), effect }
        }
        (CommandedMotion::Jog(speed), CommandedMotion::Move(_) | CommandedMotion::MoveRel(..))
            if is_at_start =>
        {
            Message::JogReplaced { function, axis, speed, effect: "replaced by a move" }
        }
        (CommandedMotion::Jog(speed), CommandedMotion::Jog(other)) if is_at_start && speed * other < 0.0 => {
            Message::JogReplaced { function, axis, speed, effect: "replaced by one in the other direction" }
        }
        (
            CommandedMotion::Move(earlier) | CommandedMotion::MoveRel(_, earlier),
            CommandedMotion::Move(target) | CommandedMotion::MoveRel(_, target),
        ) if is_after_delay && earlier != target && called.at != caller.at => {
            let Some(at) = called.at else { return };
            let other = OtherPlace { thread: Some(called.thread), at };
            Message::MoveCut { function, axis, dest, earlier, target, other }
        }
        _ => return,
    };
    parts.out.diagnose(caller, message);
}

/// Makes a remark if a thread ends the motion of an axis before the axis has moved noticeably.
pub(super) fn check_end(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId, function: Function) {
    let Some(InterruptedMotion { called, dest, is_at_start, is_after_delay }) =
        interrupted_motion(parts, caller, axis, None)
    else {
        return;
    };
    let disables = function == Function::DisableAxis;
    let effect = if disables { "ended" } else { "stopped" };
    let message = match called.motion {
        CommandedMotion::Move(earlier) | CommandedMotion::MoveRel(_, earlier) if is_at_start => {
            Message::MoveReplaced {
                function,
                axis,
                earlier: round_to_thousandths(earlier),
                effect: effect.to_owned(),
            }
        }
        CommandedMotion::Jog(speed) if is_at_start => Message::JogReplaced { function, axis, speed, effect },
        CommandedMotion::Move(earlier) | CommandedMotion::MoveRel(_, earlier)
            if is_after_delay && disables =>
        {
            Message::MoveEnded { function, axis, dest, earlier: round_to_thousandths(earlier) }
        }
        _ => return,
    };
    parts.out.diagnose(caller, message);
}

/// The motion in progress that the calling thread itself has begun on an axis. `motion` is the one that it begins now.
fn interrupted_motion(
    parts: &mut Parts,
    caller: &Caller<'_>,
    axis: AxisId,
    motion: Option<CommandedMotion>,
) -> Option<InterruptedMotion> {
    let thread = caller.thread?;
    let Wait { looked, looks, motion_looks, other_looks, .. } = *parts.calls.waits.wait_of(thread);
    let memory = &*caller.memory;
    let dest = memory.axis(axis, Chan::DEST);
    let (at, now) = (caller.at, caller.now());
    let is_asked = false;
    let own = motion.map(|motion| MotionCall {
        thread,
        at,
        motion,
        dest,
        called: now,
        last_poll: looked,
        poll_count: looks,
        motion_polls: motion_looks,
        other_polls: other_looks,
        is_polled: is_asked,
    });
    let called = parts.calls.notices.record_motion(axis, own)?;
    let is_enabled = memory.axis(axis, Chan::ENABLE) != 0;
    if called.thread != thread || !is_enabled || !has_motion(memory, axis) {
        return None;
    }
    let gone = (dest - called.dest).abs();
    let (is_near, is_far) = match called.motion {
        CommandedMotion::Move(target) | CommandedMotion::MoveRel(_, target) => {
            let way = (target - called.dest).abs();
            (gone <= f64::max(1.0, REST * way), (target - dest).abs() > REST * way)
        }
        CommandedMotion::Jog(_) => (gone <= 1.0, false),
    };
    let is_at_start = called.last_poll == looked && is_near && now - called.called < HARDLY;
    let is_move = memory.axis(axis, Chan::LAST_MOTION_TYPE) == LastMotion::Move.get();
    let is_delay = (1..=DELAYS).contains(&looks.wrapping_sub(called.poll_count));
    // It has only waited for other axes.
    let is_forgotten =
        !called.is_polled && called.motion_polls != motion_looks && called.other_polls == other_looks;
    let is_after_delay = (is_delay || is_forgotten) && is_far && is_move;
    Some(InterruptedMotion { called, dest, is_at_start, is_after_delay })
}

/// A place or distance in thousandths.
fn round_to_thousandths(value: f64) -> f64 {
    const PARTS: f64 = 1e3;
    libm::round(value * PARTS) / PARTS
}
