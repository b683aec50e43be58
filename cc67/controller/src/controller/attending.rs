//! The actions of a stimulus, performed by a person and the PC; see [`Bench`](crate::bench::Bench).

use std::mem;

use cc67_host::target::Target;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use kmotiondef::{AxisId, Bit, ThreadId};
use runtime::EventKind;
use runtime::stimulus::{Action, Subject, UserDataFormat};

use super::Controller;
use crate::bench::{BenchAct, BenchFacts};

impl Controller {
    /// Checks the conditions of the stimulus, and performs the due actions.
    pub(super) fn attend(&mut self) {
        let now = self.now();
        let mut bench = mem::take(&mut self.bench);
        if mem::take(&mut self.is_fresh) {
            bench.look(now, self);
        }
        while let Some(act) = bench.take_due(now, self) {
            match act {
                BenchAct::Act(action) => self.do_for_bench(action),
                BenchAct::Unmet(text) => self.pending.push(EventKind::Unmet(text)),
            }
        }
        self.bench = bench;
    }

    fn do_for_bench(&mut self, action: Action) {
        let done = match action {
            Action::Manual(step) => {
                self.pending.push(EventKind::Host(format!("{}{}", crate::BY_HAND, step.text)));
                Ok(())
            }
            Action::Command(line) => {
                self.send_line(line.as_bytes());
                Ok(())
            }
            Action::Start(thread) => self.start_together(&[thread]),
            Action::Kill(thread) => {
                self.stop(thread);
                Ok(())
            }
            Action::Persist(index, value) => self.write(self.element_address(index), &value.to_le_bytes()),
            Action::Answer(setting) => Target::answer(self, &setting),
            // The bench has rejected all others.
            _ => Ok(()),
        };
        if let Err(error) = done {
            self.pending.push(EventKind::Host(error.to_string()));
        }
    }

    /// Ends the stimulus: reports the expectations that are not met, and those that are not checked.
    pub(super) fn end_attending(&mut self) {
        if self.lost.is_some() {
            return;
        }
        let mut bench = mem::take(&mut self.bench);
        self.refresh();
        let unmet = bench.finish(self.now(), self);
        self.pending.extend(unmet.into_iter().map(EventKind::Unmet));
        let unchecked = bench.unchecked(self);
        if !unchecked.is_empty() {
            let text = format!("{}{}", crate::UNCHECKED, unchecked.join(", "));
            self.pending.push(EventKind::Host(text));
        }
        self.bench = bench;
    }
}

impl BenchFacts for Controller {
    fn value(&self, subject: &Subject) -> Option<f64> {
        let word = |index: usize| {
            let mut bytes = [0; 4];
            let place = PERSIST.field(Persist::USER_DATA).element(index).address();
            self.read(self.place_of(place), &mut bytes).ok()?;
            Some(u32::from_le_bytes(bytes))
        };
        match subject {
            Subject::Item(item, _) => Some(Target::value(self, *item)).filter(|value| !value.is_nan()),
            Subject::Persist(index, UserDataFormat::Whole) => {
                word(*index).map(|word| f64::from(word.cast_signed()))
            }
            Subject::Persist(index, UserDataFormat::Single) => {
                word(*index).map(|word| f64::from(f32::from_bits(word)))
            }
            Subject::Persist(index, UserDataFormat::Double) => {
                let (low, high) = (u64::from(word(*index)?), u64::from(word(*index + 1)?));
                Some(f64::from_bits(high << 32 | low))
            }
            Subject::Expression(_) => None,
        }
    }

    fn level(&self, bit: Bit) -> Option<bool> {
        self.status()?.bit(bit)
    }

    fn is_enabled(&self, axis: AxisId) -> bool {
        self.status().is_some_and(|status| status.is_enabled(axis))
    }

    fn is_active(&self, thread: ThreadId) -> bool {
        self.thread(thread).is_active()
    }
}
