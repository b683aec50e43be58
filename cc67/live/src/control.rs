//! What pages may do to the time of the board.

use crate::request::PageRequest;

/// What pages may do to the time of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeControl {
    /// Stop it, let it run at any speed, go back and begin again.
    Full,
    /// Stop it and let it run at any speed. It does not go back, as others use the board.
    Forward,
    /// Nothing: it passes as others use the board.
    Foreign,
}

impl TimeControl {
    /// What pages are told.
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Forward => "forward",
            Self::Foreign => "foreign",
        }
    }

    /// Whether a page may ask for this; else why not.
    pub(crate) fn allows(self, request: &PageRequest) -> Result<(), String> {
        let refused = match request {
            PageRequest::Run { .. }
            | PageRequest::Pause {}
            | PageRequest::Tick {}
            | PageRequest::Slice {} => {
                (self == Self::Foreign).then_some("the time of this board passes as its clients need it")
            }
            PageRequest::Goto { .. } | PageRequest::Restart {} => {
                (self != Self::Full).then_some("this board is used by clients, and does not go back in time")
            }
            PageRequest::Save { .. } => (self != Self::Full)
                .then_some("this board is used by clients: what they do is not part of a test"),
            PageRequest::Rate { .. }
            | PageRequest::Act { .. }
            | PageRequest::Command { .. }
            | PageRequest::Start { .. }
            | PageRequest::Stop { .. }
            | PageRequest::Reload {}
            | PageRequest::Watch { .. }
            | PageRequest::Gather { .. }
            | PageRequest::Write { .. } => None,
        };
        refused.map_or(Ok(()), |why| Err(why.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_board_does_not_go_back_in_time() {
        let back = PageRequest::Goto { tick: 0 };
        let pause = PageRequest::Pause {};
        let click = PageRequest::Act { text: "bit 136 = 1".to_owned() };
        for (control, allowed) in [
            (TimeControl::Full, [true, true, true]),
            (TimeControl::Forward, [false, true, true]),
            (TimeControl::Foreign, [false, false, true]),
        ] {
            assert_eq!([&back, &pause, &click].map(|request| control.allows(request).is_ok()), allowed);
        }
    }
}
