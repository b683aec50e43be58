//! The final state of the board: axes, bits, elements of `persist.UserData`.

use std::collections::BTreeMap;

use cc67_host::{Capability, Session, Target};
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::{PERSIST, chan};
use kmotiondef::{AxisId, Bit};
use runtime::trace::Item;
use serde::Serialize;

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct FinalState {
    /// The axes that are enabled or not at 0.
    axes: Vec<AxisState>,
    /// The bits that are 1.
    bits: Vec<u16>,
    /// The elements that are not 0.
    persist: BTreeMap<usize, i32>,
}

/// The state of an axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct AxisState {
    axis: u8,
    enabled: bool,
    dest: f64,
    position: f64,
    velocity: f64,
}

impl FinalState {
    /// The present state.
    pub(crate) fn of<T: Target>(session: &Session<T>) -> Self {
        // With a firmware that lacks the variables of the surroundings, nothing is shown.
        if !session.can(Capability::Surroundings) {
            return Self::default();
        }
        let value = |item| session.target().value(item);
        let bits = (0..=i32::from(Bit::MAX)).filter_map(Bit::new);
        let data = PERSIST.field(Persist::USER_DATA);
        let elements =
            (0..N_USER_DATA_VARS).map(|index| (index, session.peek_object(data.element(index).address())));
        Self {
            axes: session.target().axes().iter().filter_map(|axis| AxisState::of(session, axis)).collect(),
            bits: bits.filter(|bit| value(Item::of_bit(*bit)) != 0.0).map(Bit::get).collect(),
            persist: elements.filter(|(_, value)| *value != 0).collect(),
        }
    }

    /// The state as lines of text.
    pub(crate) fn lines(&self) -> Vec<String> {
        let axis = |state: &AxisState| {
            let enabled = if state.enabled { "enabled" } else { "disabled" };
            let AxisState { axis, dest, position, velocity, .. } = state;
            let moves = if *velocity == 0.0 { String::new() } else { format!(", velocity {velocity}") };
            format!("axis {axis} {enabled}, dest {dest}, position {position}{moves}")
        };
        let mut lines: Vec<String> = self.axes.iter().map(axis).collect();
        if !self.bits.is_empty() {
            lines.push(format!("bits that are 1: {}", ranges(&self.bits)));
        }
        if !self.persist.is_empty() {
            let elements: Vec<_> =
                self.persist.iter().map(|(index, value)| format!("{index} = {value}")).collect();
            lines.push(format!("persist {}", elements.join(", ")));
        }
        lines.into_iter().map(|line| format!("final state: {line}")).collect()
    }
}

impl AxisState {
    fn of<T: Target>(session: &Session<T>, axis: AxisId) -> Option<Self> {
        let value = |kind: &str| {
            Item::among(session.target().axes(), &format!("{kind}{axis}"))
                .map_or(0.0, |item| session.target().value(item))
        };
        let place = chan(axis).field(Chan::ENABLE);
        let enabled = session.peek_object::<u32>(place.address()) != 0;
        let state = Self {
            axis: axis.get(),
            enabled,
            dest: value("dest"),
            position: value("pos"),
            velocity: value("vel"),
        };
        (enabled || state.dest != 0.0 || state.position != 0.0).then_some(state)
    }
}

/// Numbers as ranges: "8, 140-143".
fn ranges(numbers: &[u16]) -> String {
    let runs = numbers.chunk_by(|one, next| one + 1 == *next);
    let shown = runs.filter_map(|run| match run {
        [] => None,
        [one] => Some(one.to_string()),
        [first, .., last] => Some(format!("{first}-{last}")),
    });
    shown.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::ranges;

    #[test]
    fn consecutive_numbers_become_a_range() {
        assert_eq!(ranges(&[8, 140, 141, 142, 1024]), "8, 140-142, 1024");
    }
}
