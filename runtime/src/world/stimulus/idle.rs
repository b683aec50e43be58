//! Actions that set an input to the level that it already has, and so change nothing.
//!
//! The level is probably wrong: that of a contact that opens, or of a switch that is closed at rest. An action that
//! detaches an input from its switch counts as a change, because the switch no longer moves the input.

use kmotiondef::Bit;

use super::action::Action;
use super::acts::lines::level;
use super::scene::Scene;
use super::wave::Wave;
use chips::kanalog::conversion;

/// The input and its present level, if an action changes nothing.
pub(super) fn state(scene: &Scene<'_, '_, '_>, action: &Action) -> Option<String> {
    let mechanics = &scene.access.machine.mechanics;
    match action {
        Action::Set(bit, new) => same_level(scene, *bit, *new),
        Action::Press(bit) => {
            let active = mechanics.contact(*bit).is_none_or(|(.., active)| active);
            same_level(scene, *bit, active)
        }
        Action::Release(bit) if mechanics.contact(*bit).is_some() => {
            (!mechanics.is_held(*bit)).then(|| format!("no action overrides the switch on bit {bit}"))
        }
        Action::Release(bit) => same_level(scene, *bit, scene.access.io.pins.is_described(*bit)),
        Action::Adc(channel, Wave::Constant(value)) => same_value(scene, *channel, *value),
        Action::Konnect(board, input, new) => {
            let is_same = scene.access.io.konnects.input(*board, *input) == *new;
            let address = board.address;
            is_same.then(|| format!("input {input} of Konnect {address} was {} already", u8::from(*new)))
        }
        Action::Manual(step) => state(scene, &step.action),
        _ => None,
    }
}

/// The bit that an action changes.
pub(super) fn bit(action: &Action) -> Option<Bit> {
    match action {
        Action::Set(bit, _)
        | Action::Toggle(bit)
        | Action::Pulse(bit, _)
        | Action::Press(bit)
        | Action::Release(bit)
        | Action::Bounce(bit, _) => Some(*bit),
        Action::Manual(step) => bit(&step.action),
        _ => None,
    }
}

fn same_level(scene: &Scene<'_, '_, '_>, bit: Bit, new: bool) -> Option<String> {
    let mechanics = &scene.access.machine.mechanics;
    let takes_it = mechanics.contact(bit).is_some() && !mechanics.is_held(bit);
    if takes_it || level(scene, bit) != new {
        return None;
    }
    let is_at_rest = new && scene.access.io.pins.is_described(bit) && !scene.moved.contains(&bit);
    let cause = if is_at_rest { ", as `idle_high` says" } else { "" };
    Some(format!("bit {bit} was {} already{cause}", u8::from(new)))
}

fn same_value(scene: &Scene<'_, '_, '_>, channel: usize, value: f64) -> Option<String> {
    let access = &scene.access;
    let others =
        access.machine.mechanics.has_source(channel) || scene.plans.has_wave(channel, scene.context.now);
    let is_same = access.io.kanalog.conversions().get(channel) == Some(&conversion(value));
    (is_same && !others).then(|| format!("adc {channel} was {value} already"))
}
