//! An operator for programs that wait for undriven inputs: `--assist`.
//!
//! When the programs have only polled inputs and waited for two seconds, one of these inputs is toggled for a tenth of
//! a second; if that has no effect, the next one. All times are board time. Source: plant.md section 7.

use std::collections::BTreeMap;

use kmotiondef::{Bit, CodeAddr, Cycles, ThreadId};

/// The time for which programs wait before the operator acts: 2 s.
const PATIENCE: Cycles = Cycles::new(2 * Cycles::PER_SECOND.get());
/// The time for which an input stays toggled: 0.1 s. The programs have the same time again to react.
const PRESSED: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 10);

/// The reader of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct InputReader {
    /// The thread; `None` for the call-back.
    pub(crate) thread: Option<ThreadId>,
    /// The instruction that reads.
    pub(crate) at: Option<CodeAddr>,
}

/// An action of the operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Toggles an input; who has read it last.
    Press(Bit, InputReader),
    /// Gives it back the level it had.
    Release(Bit),
}

/// The operator.
#[derive(Clone, Debug)]
pub(crate) struct Assist {
    /// Inputs that were read since the last other action of the programs, and their readers.
    polled: BTreeMap<Bit, InputReader>,
    /// The time of the next action.
    next: Cycles,
    pressed: Option<Bit>,
    /// True if the programs have reacted since it was pressed.
    has_helped: bool,
    /// The last input that was pressed: the following one is next.
    last: Option<Bit>,
}

impl Assist {
    pub(crate) fn new(now: Cycles) -> Self {
        Self { polled: BTreeMap::new(), next: now + PATIENCE, pressed: None, has_helped: false, last: None }
    }

    /// Notes that a program has called a function, which may be one that programs call while they wait.
    pub(crate) fn note_call(&mut self, waits: bool, now: Cycles) {
        if !waits {
            self.polled.clear();
            self.has_helped = true;
            if self.pressed.is_none() {
                self.next = now + PATIENCE;
            }
        }
    }

    /// A program has read an input.
    pub(crate) fn polled(&mut self, bit: Bit, reader: InputReader) {
        self.polled.insert(bit, reader);
    }

    /// Returns the action that is due at the beginning of a tick.
    pub(crate) fn step(&mut self, now: Cycles) -> Option<Step> {
        if now < self.next {
            return None;
        }
        self.next = now + PRESSED;
        if let Some(bit) = self.pressed.take() {
            // A program that has reacted is not disturbed for a while.
            if self.has_helped {
                self.next = now + PATIENCE;
            }
            return Some(Step::Release(bit));
        }
        let inputs = || self.polled.iter().map(|(bit, reader)| (*bit, *reader));
        let (bit, reader) = inputs().find(|(bit, _)| Some(*bit) > self.last).or_else(|| inputs().next())?;
        (self.last, self.pressed, self.has_helped) = (Some(bit), Some(bit), false);
        Some(Step::Press(bit, reader))
    }

    /// Returns the number of ticks without any action after the one that began at `now`.
    pub(crate) fn quiet_ticks(&self, now: Cycles) -> u64 {
        let rest = (self.next - now).get() / Cycles::PER_TICK.get() - 1;
        u64::try_from(rest).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASKER: InputReader = InputReader { thread: None, at: None };

    fn ms(ms: i64) -> Cycles {
        Cycles::new(ms * Cycles::PER_SECOND.get() / 1000)
    }

    #[test]
    fn inputs_are_pressed_in_turn_after_two_seconds_of_waiting() {
        let bit = |number| Bit::new(number).expect("a bit");
        let mut assist = Assist::new(ms(0));
        assist.note_call(false, ms(500));
        assist.polled(bit(10), ASKER);
        assist.polled(bit(136), ASKER);
        assist.note_call(true, ms(1000));
        for (at, expect) in [
            (2499, None),
            (2500, Some(Step::Press(bit(10), ASKER))),
            (2600, Some(Step::Release(bit(10)))),
            (2700, Some(Step::Press(bit(136), ASKER))),
            (2800, Some(Step::Release(bit(136)))),
            (2900, Some(Step::Press(bit(10), ASKER))),
        ] {
            assert_eq!(assist.step(ms(at)), expect, "{at}");
        }
        assist.note_call(false, ms(2950));
        assert_eq!(assist.step(ms(3000)), Some(Step::Release(bit(10))));
        assert_eq!(assist.step(ms(4999)), None);
    }
}
