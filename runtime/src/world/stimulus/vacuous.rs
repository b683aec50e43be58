//! Expectations that cannot fail, because their subject never changes.
//!
//! The number of an axis or an input is easily mistyped, and such an expectation is then always met. A test may also
//! intend to check that an axis or an output rests: so there is only a remark for a limit away from rest and, if the
//! machine has the axis, only if no other statement limits an axis that moves. Expectations of a moment are only
//! examined for bits.

use kmotiondef::bits::BitDirection;
use kmotiondef::structs::Chan;
use kmotiondef::{AxisId, Bit};

use super::Rule;
use super::action::Action;
use super::expectation::{Expectation, Predicate, Subject};
use super::monitor::Progress;
use super::relation::Relation;
use super::trigger::Trigger;
use crate::io::bits::range_of;
use crate::machine::Channel;
use crate::views::TypedAccess;
use crate::world::trace::{Item, View};

/// The subject of an expectation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LimitedQuantity {
    Axis(AxisId),
    /// The position that an axis reads.
    Position(AxisId),
    Dac(usize),
    Pwm(usize),
    Bit(Bit),
}

/// Returns the reason why an expectation could not fail, if it could not.
pub(super) fn cause(rules: &[Rule], progress: &[Progress], index: usize, view: &View<'_>) -> Option<String> {
    let varied = |index: usize| progress.get(index).is_none_or(Progress::has_varied);
    let rule = rules.get(index)?;
    if varied(index) && is_of_the_run(rule) {
        return None;
    }
    match limited_quantity(rule, view)? {
        LimitedQuantity::Position(axis)
            if is_used(axis, view) && view.memory.axis(axis, Chan::INPUT_MODE) == 0 =>
        {
            let others = "`dest` is its target, `load` the place of its load";
            Some(format!("axis {axis} has no input and stays at position 0 ({others})"))
        }
        LimitedQuantity::Axis(axis) | LimitedQuantity::Position(axis) => {
            let others = || view.memory.axes().iter().filter(|other| *other != axis);
            let limits_used = |(index, rule)| {
                use LimitedQuantity::{Axis, Position};
                let is_limited = |other| varied(index) || is_used(other, view);
                matches!(limited_quantity(rule, view), Some(Axis(other) | Position(other)) if is_limited(other))
            };
            let is_odd = !view.machine.has_axis(axis) || !rules.iter().enumerate().any(limits_used);
            let is_idle = !is_used(axis, view) && others().any(|other| is_used(other, view));
            (is_idle && is_odd).then(|| format!("axis {axis} is never used in this run"))
        }
        LimitedQuantity::Dac(number) => {
            let is_other = |channel| matches!(channel, Channel::Dac(other) if other != number);
            let is_odd = is_only_other(view, is_other, Channel::Dac(number));
            is_odd.then(|| format!("DAC {number} is never written in this run"))
        }
        LimitedQuantity::Pwm(number) => {
            let is_other = |channel| matches!(channel, Channel::Pwm(other) if other != number);
            let is_odd = is_only_other(view, is_other, Channel::Pwm(number));
            is_odd.then(|| format!("PWM channel {number} is never written in this run"))
        }
        LimitedQuantity::Bit(bit) => idle_bit(bit, view),
    }
}

/// Returns whether an expectation holds for the whole run.
const fn is_of_the_run(rule: &Rule) -> bool {
    matches!(rule.trigger, Trigger::Always { .. })
}

/// Returns the part of the board that an expectation limits.
fn limited_quantity(rule: &Rule, view: &View<'_>) -> Option<LimitedQuantity> {
    let Action::Expect(Expectation { predicate, .. }) = &rule.action else { return None };
    let Predicate::Value { subject: Subject::Item(item, _), relation, number, .. } = predicate else {
        return None;
    };
    if let Some(bit) = item.bit() {
        return Some(LimitedQuantity::Bit(bit));
    }
    if !is_of_the_run(rule) {
        return None;
    }
    let is_limit = !matches!(relation, Relation::Equal | Relation::Different) && *number != 0.0;
    is_limit.then(|| of_item(*item, view)).flatten()
}

fn of_item(item: Item, view: &View<'_>) -> Option<LimitedQuantity> {
    match item.kind() {
        "pos" => axis_of(item, view).map(LimitedQuantity::Position),
        "dest" | "out" | "vel" | "load" => axis_of(item, view).map(LimitedQuantity::Axis),
        "dac" => Some(LimitedQuantity::Dac(item.index())),
        "pwm" => Some(LimitedQuantity::Pwm(item.index())),
        _ => None,
    }
}

fn axis_of(item: Item, view: &View<'_>) -> Option<AxisId> {
    view.memory.axes().iter().find(|axis| axis.index() == item.index())
}

/// Returns whether a program has prepared or moved an axis.
fn is_used(axis: AxisId, view: &View<'_>) -> bool {
    let memory = view.memory;
    memory.axis(axis, Chan::ENABLE) != 0
        || memory.axis(axis, Chan::OUTPUT_MODE) != 0
        || memory.axis(axis, Chan::DEST) != 0.0
        || memory.axis(axis, Chan::POSITION) != 0.0
}

/// Returns whether the machine file names other outputs of the same kind, but not this one.
fn is_only_other(view: &View<'_>, is_other: impl Fn(Channel) -> bool, this: Channel) -> bool {
    let named = view.machine.outputs();
    named.iter().any(|channel| is_other(*channel)) && !named.contains(&this)
}

/// Returns the reason why a bit keeps its level, whatever the programs do.
fn idle_bit(bit: Bit, view: &View<'_>) -> Option<String> {
    let Some(range) = range_of(view.io, bit) else {
        return Some(format!("nothing is connected to bit {bit}"));
    };
    let pins = &view.io.pins;
    if pins.is_driven(bit) || pins.is_described(bit) {
        return None;
    }
    match range.direction {
        BitDirection::Input => Some(format!("bit {bit} is an input that nothing drives")),
        BitDirection::Programmable if !pins.is_output(bit) => {
            Some(format!("bit {bit} is an input that nothing drives: SetBitDirection makes it an output"))
        }
        BitDirection::Programmable | BitDirection::Output | BitDirection::Memory => None,
    }
}
