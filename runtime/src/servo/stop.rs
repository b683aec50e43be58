//! A feedhold that the primary thread carries out: for the servo at a limit, or for a command.
//!
//! It takes several of its slices: in the first it computes the duration of the stop, in the next it begins to stop a
//! path; axes that move independently take one further slice each (coordinated-motion.md section 5).

use kmotiondef::AxisId;

/// The time at which a stop is reported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StopReport {
    /// If a motion was stopped.
    Stop,
    /// At every attempt: repeatedly for an axis outside of the coordinate system, which cannot be stopped.
    Always,
    /// Never: it was requested.
    Never,
}

/// The feedhold, if one is requested.
#[derive(Clone, Debug, Default)]
pub(crate) struct StopRequest {
    asked: Option<(String, StopReport)>,
    /// True if the primary thread has seen it: computing the stop takes it until its next slice.
    is_seen: bool,
    /// The axes that are still to be stopped, the last one first.
    left: Vec<AxisId>,
}

impl StopRequest {
    /// Asks, unless a stop is being computed.
    pub(super) fn ask(&mut self, text: String, tells: StopReport) {
        if self.left.is_empty() {
            self.asked.get_or_insert((text, tells));
        }
    }

    /// Notes the request of a command, for which the primary thread has computed the stop.
    pub(super) fn ask_by_command(&mut self) {
        self.ask(String::new(), StopReport::Never);
        self.is_seen = true;
    }

    /// Returns whether a stop is requested.
    pub(super) const fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    /// Returns whether the primary thread sees it for the first time.
    pub(super) const fn is_new(&mut self) -> bool {
        !std::mem::replace(&mut self.is_seen, true)
    }

    /// Takes the request, which has been executed.
    pub(super) fn take(&mut self) -> Option<(String, StopReport)> {
        self.is_seen = false;
        self.asked.take()
    }

    /// Stops these axes, one in each slice.
    pub(super) fn stop_in_turn(&mut self, mut axes: Vec<AxisId>) {
        axes.reverse();
        self.left = axes;
    }

    /// The axis that is stopped next, and whether it is the last one.
    pub(super) fn next_axis(&mut self) -> Option<(AxisId, bool)> {
        let axis = self.left.pop()?;
        Some((axis, self.left.is_empty()))
    }
}
