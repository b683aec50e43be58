//! `MoveXYZABC`: a move of each axis of the coordinate system, in turn.

use kmotiondef::AxisId;
use kmotiondef::firmware::Function;
use kmotiondef::modes::LastMotion;
use kmotiondef::structs::Chan;
use vm::firmware::{Caller, Outcome, Wake};

use super::schedule::{self, PlanningStage, row_cost};
use super::{FARTHEST, is_beyond, is_number, may_move, no_limits, replaced};
use crate::firmware::calls::{CommandedMotion, Continuation};
use crate::firmware::parts::Parts;
use crate::firmware::{axis_check, costs};
use crate::out::Message;
use crate::servo::coordinated::system;
use crate::servo::moves::{Planner, limits, start_move_to};
use crate::servo::planning;
use crate::views::TypedAccess;

/// The letters of `MoveXYZABC`.
const LETTERS: [char; 6] = ['X', 'Y', 'Z', 'A', 'B', 'C'];

/// Cycles of the call itself, and of a letter without an axis.
const CALL: i64 = 70;
const LETTER: i64 = 25;

#[expect(clippy::too_many_arguments, reason = "the C function has six coordinates")]
pub(crate) fn move_xyzabc(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    x: f64,
    y: f64,
    z: f64,
    a: f64,
    b: f64,
    c: f64,
) -> Outcome<()> {
    let targets = [x, y, z, a, b, c];
    if parts.servo.planner == Planner::Direct {
        return all_at_once(parts, caller, targets);
    }
    let (mut left, mut progress) = match (caller.woken, parts.calls.take(caller)) {
        (Some(_), Some(Continuation::Moves(left, progress))) => (left, progress),
        _ => {
            notice_letters(parts, caller, targets);
            let mut moves = axis_targets(caller, targets);
            moves.reverse();
            costs::spend(caller, CALL - row_cost(Function::MoveXYZABC));
            (moves, PlanningStage::Called)
        }
    };
    while let Some(&(axis, target)) = left.last() {
        if let Some(pause) = step(parts, caller, (axis, target), progress) {
            parts.calls.store(caller, Continuation::Moves(left, pause.then));
            return Outcome::Wait(pause.wake);
        }
        // Even for an axis that is disabled or beyond a limit.
        caller.memory.set_axis(axis, Chan::LAST_MOTION_TYPE, LastMotion::Multi.get());
        left.pop();
        progress = PlanningStage::Called;
    }
    let without = system::letters(caller.memory).into_iter().take(LETTERS.len()).filter(Option::is_none);
    costs::spend(caller, LETTER * without.count() as i64);
    Outcome::Done(())
}

/// Moves one axis; the wait before it can.
fn step(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    (axis, target): (AxisId, f64),
    progress: PlanningStage,
) -> Option<schedule::Pause> {
    let function = Function::MoveXYZABC;
    if progress == PlanningStage::Called {
        if !may_move(parts, caller, axis, function) {
            costs::spend(caller, costs::REFUSED);
            return None;
        }
        let way = target - caller.memory.axis(axis, Chan::DEST);
        if !is_number(parts, caller, function, target) || is_beyond(parts, caller, function, axis, way) {
            costs::spend(caller, costs::REFUSED);
            return None;
        }
        replaced::check_begin(parts, caller, axis, function, CommandedMotion::Move(target));
        axis_check::check_move(parts, caller, function, axis);
        axis_check::target_beyond(parts, caller, function, axis, target);
    }
    let target = target.clamp(-FARTHEST, FARTHEST);
    let Some(limits) = limits(caller.memory, axis, None) else {
        no_limits(parts, caller, axis, function);
        return None;
    };
    let planning = |caller: &Caller<'_>| planning::of_move(caller.memory, axis, target, &limits);
    if let Some(pause) = schedule::plan(parts, caller, axis, progress, 0, planning) {
        return Some(pause);
    }
    let planner = parts.servo.planner;
    start_move_to(caller.memory, axis, target, (&limits, limits.a), LastMotion::Multi, planner);
    None
}

/// The axes of the letters and their targets.
fn axis_targets(caller: &Caller<'_>, targets: [f64; 6]) -> Vec<(AxisId, f64)> {
    let letters = system::letters(caller.memory).into_iter().zip(targets);
    letters.filter_map(|(axis, target)| Some((axis?, target))).collect()
}

/// Tells a program that gives a target to a letter without an axis.
fn notice_letters(parts: &mut Parts, caller: &Caller<'_>, targets: [f64; 6]) {
    for ((letter, axis), target) in LETTERS.into_iter().zip(system::letters(caller.memory)).zip(targets) {
        if axis.is_none() && target != 0.0 {
            let function = Function::MoveXYZABC;
            parts.out.diagnose(caller, Message::NoAxisForLetter { function, letter, target });
        }
    }
}

/// Plans all axes in the slice after the call, as firmware 5 does: it waits even if all axes are at rest.
fn all_at_once(parts: &mut Parts, caller: &mut Caller<'_>, targets: [f64; 6]) -> Outcome<()> {
    let function = Function::MoveXYZABC;
    let moves = axis_targets(caller, targets);
    if caller.woken.is_none() && caller.thread.is_some() {
        let wake = moves.first().and_then(|&(axis, _)| schedule::planning_wait(parts, caller, axis));
        return Outcome::Wait(wake.unwrap_or(Wake::NextSlice));
    }
    if caller.woken.is_some() {
        costs::spend(caller, costs::AFTER_MOVES);
    }
    notice_letters(parts, caller, targets);
    for (axis, target) in moves {
        if may_move(parts, caller, axis, function) && is_number(parts, caller, function, target) {
            replaced::check_begin(parts, caller, axis, function, CommandedMotion::Move(target));
            axis_check::check_move(parts, caller, function, axis);
            axis_check::target_beyond(parts, caller, function, axis, target);
            let target = target.clamp(-FARTHEST, FARTHEST);
            match limits(caller.memory, axis, None) {
                Some(limits) => {
                    let planner = parts.servo.planner;
                    let limits = (&limits, limits.a);
                    start_move_to(caller.memory, axis, target, limits, LastMotion::Multi, planner);
                }
                None => no_limits(parts, caller, axis, function),
            }
        }
    }
    Outcome::Done(())
}
