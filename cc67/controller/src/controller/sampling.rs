//! Samples of variables by a program on the board, see [`Sampler`].

use std::mem;

use cc67_host::HostError;
use cc67_host::target::Target as _;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{ThreadId, Ticks};
use runtime::EventKind;
use runtime::trace::Quantity;

use super::Controller;
use crate::sampler::{SampledRow, Sampler};

/// The sampler of a board, and the rows that have not been taken yet.
#[derive(Debug)]
pub(super) struct ActiveSampling {
    sampler: Sampler,
    /// The time of power-up, in seconds of this session.
    power_up: f64,
    rows: Vec<(Ticks, Vec<f64>)>,
}

impl ActiveSampling {
    /// Takes the rows since the last call.
    pub(super) fn take(&mut self) -> Vec<(Ticks, Vec<f64>)> {
        mem::take(&mut self.rows)
    }

    /// The thread of the sampler.
    pub(super) const fn thread(&self) -> ThreadId {
        self.sampler.thread()
    }

    fn add(&mut self, row: SampledRow) {
        let tick = ((row.seconds + self.power_up) / TIMEBASE).round().max(0.0);
        self.rows.push((Ticks::new(tick as u64), row.values));
    }
}

impl Controller {
    /// Begins to sample in a free thread; ends sampling if there are no quantities. Returns the number of samples per
    /// second.
    pub(super) fn begin_sampling(&mut self, quantities: &[Quantity]) -> Result<f64, HostError> {
        self.end_sampling();
        if quantities.is_empty() {
            return Ok(0.0);
        }
        let Some(thread) = self.threads.free().last().copied() else {
            let why = "no thread is free for cc67's sampler: all have programs or are active";
            return Err(HostError::Link(why.to_owned()));
        };
        let Some(sampler) = Sampler::new(thread, quantities, |address| self.place_of(address)) else {
            return Err(HostError::Link("none of the signals is a variable of the board".to_owned()));
        };
        self.refresh();
        let board_seconds = self.status().map_or(0.0, cc67_wire::Status::time);
        self.time.note();
        let power_up = self.tick().get() as f64 * TIMEBASE - board_seconds;
        let (options, linked_for) = self.monitor.get_mut().options();
        sampler.begin(self.client.get_mut(), options, linked_for)?;
        self.monitor.get_mut().invalidate(thread);
        self.threads.note_served(thread);
        let rate = sampler.rate();
        self.sampling = Some(ActiveSampling { sampler, power_up, rows: Vec::new() });
        Ok(rate)
    }

    /// Reads the new samples.
    pub(super) fn read_samples(&mut self) {
        let Some(mut sampling) = self.sampling.take() else { return };
        if !self.thread(sampling.thread()).is_active() {
            self.pending.push(EventKind::Host(format!(
                "cc67's sampler in thread {} was stopped: 20 samples a second from now on",
                sampling.thread()
            )));
            return;
        }
        match sampling.sampler.read(self.client.get_mut()) {
            Ok(rows) => {
                rows.into_iter().for_each(|row| sampling.add(row));
                self.sampling = Some(sampling);
            }
            Err(error) => self.note_error(&error),
        }
    }

    /// Stops the sampler.
    pub(super) fn end_sampling(&mut self) {
        let Some(sampling) = self.sampling.take().filter(|_| self.lost.is_none()) else { return };
        if let Err(error) = self.client.get_mut().stop_thread(sampling.thread()) {
            self.note_error(&error);
        }
        self.threads.note_stopped(sampling.thread());
    }
}
