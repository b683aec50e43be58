//! A feedhold that the servo asks the primary thread for.

/// When the stop at a limit is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tells {
    /// If something was stopped.
    Stop,
    /// Whenever it was tried: again and again of an axis outside the coordinate system, which nothing stops.
    Always,
}

/// The feedhold, if one is asked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct StopRequest {
    asked: Option<(String, Tells)>,
    /// Whether the primary thread has seen it: computing the stop takes it until its next slice.
    is_seen: bool,
}

impl StopRequest {
    /// Asks, unless a stop is being computed.
    pub(super) fn ask(&mut self, text: String, tells: Tells) {
        self.asked.get_or_insert((text, tells));
    }

    /// Whether a stop is asked for.
    pub(super) const fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    /// Whether the primary thread sees it for the first time.
    pub(super) const fn is_new(&mut self) -> bool {
        !std::mem::replace(&mut self.is_seen, true)
    }

    /// The request, which is met.
    pub(super) fn take(&mut self) -> Option<(String, Tells)> {
        self.is_seen = false;
        self.asked.take()
    }
}
