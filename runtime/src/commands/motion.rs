//! Independent motion, and energising a motor by hand.

use vm::firmware::Outcome;

use kmotiondef::structs::Chan;

use super::arguments::Values;
use super::axes::pointer;
use super::session::{Answer, Session};
use crate::firmware::motion;
use crate::views::TypedAccess;

/// A motion call from the primary thread, which plans at once.
pub(super) fn planned_answer(outcome: Outcome<()>) -> Answer {
    debug_assert_eq!(outcome, Outcome::Done(()), "only user threads wait for a slice to plan in");
    Answer::Nothing
}

pub(super) fn move_to(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, x) = (values.integer(0), values.real(1));
    planned_answer(session.call(|parts, caller| motion::move_to(parts, caller, axis, x)))
}

pub(super) fn move_rel(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, dx) = (values.integer(0), values.real(1));
    planned_answer(session.call(|parts, caller| motion::move_rel(parts, caller, axis, dx)))
}

pub(super) fn move_at_vel(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, x, velocity) = (values.integer(0), values.real(1), values.single(2));
    planned_answer(session.call(|parts, caller| motion::move_at_vel(parts, caller, axis, x, velocity)))
}

pub(super) fn move_rel_at_vel(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, dx, velocity) = (values.integer(0), values.real(1), values.single(2));
    planned_answer(session.call(|parts, caller| motion::move_rel_at_vel(parts, caller, axis, dx, velocity)))
}

pub(super) fn move_exp(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, x, tau) = (values.integer(0), values.real(1), values.real(2));
    planned_answer(session.call(|parts, caller| motion::move_exp(parts, caller, axis, x, tau)))
}

pub(super) fn move_xyzabc(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let [x, y, z, a, b, c] = std::array::from_fn(|index| values.real(index));
    planned_answer(session.call(|parts, caller| motion::move_xyzabc(parts, caller, x, y, z, a, b, c)))
}

pub(super) fn jog(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, velocity) = (values.integer(0), values.real(1));
    planned_answer(session.call(|parts, caller| motion::jog(parts, caller, axis, velocity)))
}

pub(super) fn move_at_vel_accel(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, x, velocity, accel) = (values.integer(0), values.real(1), values.single(2), values.single(3));
    planned_answer(
        session.call(|parts, caller| motion::move_at_vel_accel(parts, caller, axis, x, velocity, accel)),
    )
}

pub(super) fn move_rel_at_vel_accel(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, dx, velocity, accel) = (values.integer(0), values.real(1), values.single(2), values.single(3));
    planned_answer(
        session.call(|parts, caller| motion::move_rel_at_vel_accel(parts, caller, axis, dx, velocity, accel)),
    )
}

pub(super) fn jog_at_accel(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, velocity, accel) = (values.integer(0), values.real(1), values.real(2));
    planned_answer(session.call(|parts, caller| motion::jog_at_accel(parts, caller, axis, velocity, accel)))
}

/// Of each axis the two words of its destination, the lower one first, and its speed.
pub(super) fn destinations_and_velocities(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    let memory = &*session.memory();
    let words = memory.axes().iter().flat_map(|axis| {
        let dest = memory.axis(axis, Chan::DEST).to_bits();
        [dest as u32, (dest >> 32) as u32, memory.axis(axis, Chan::LAST_VEL).to_bits()]
    });
    words.map(|word| format!("{word:08X}")).collect::<Vec<_>>().join(" ").into()
}

pub(super) fn check_done(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.call(|parts, caller| motion::check_done(parts, caller, values.integer(0))).into()
}

pub(super) fn check_done_xyzabc(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    session.call(motion::check_done_xyzabc).into()
}

pub(super) fn three_phase(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, amplitude, angle) =
        (pointer(session.memory(), values.axis()), values.single(1), values.real(2));
    session.call(|parts, caller| motion::write_3ph(parts, caller, axis, amplitude, angle));
    Answer::Nothing
}

pub(super) fn four_phase(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (axis, amplitude, angle) =
        (pointer(session.memory(), values.axis()), values.single(1), values.real(2));
    session.call(|parts, caller| motion::write_4ph(parts, caller, axis, amplitude, angle));
    Answer::Nothing
}
