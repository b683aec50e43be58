//! The rights of pages over the board and its time.

use crate::request::PageRequest;

/// The control of pages over the time of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimeControl {
    /// Pages can stop the board, let it run at any speed, go back and restart.
    Full,
    /// Pages can stop the board and let it run at any speed, but not go back, as others use the board.
    Forward,
    /// Pages have no control: time passes as others use the board.
    Foreign,
    /// Pages have no control: the board is a controller, whose time passes by itself.
    Real,
}

impl TimeControl {
    /// Returns the name of this control for pages.
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Forward => "forward",
            Self::Foreign => "foreign",
            Self::Real => "real",
        }
    }

    /// Returns an error if a page may not make this request.
    pub(crate) fn allows(self, request: &PageRequest) -> Result<(), String> {
        let refused = match request {
            PageRequest::Run { .. }
            | PageRequest::Pause {}
            | PageRequest::Tick {}
            | PageRequest::Slice {} => match self {
                Self::Full | Self::Forward => None,
                Self::Foreign => Some("the time of this board passes as its clients need it"),
                Self::Real => Some("the time of a connected controller cannot be stopped"),
            },
            PageRequest::Goto { .. }
            | PageRequest::Branch { .. }
            | PageRequest::Forget { .. }
            | PageRequest::Restart {} => match self {
                Self::Full => None,
                Self::Forward | Self::Foreign => {
                    Some("this board is used by clients, and does not go back in time")
                }
                Self::Real => Some("a connected controller does not go back in time"),
            },
            PageRequest::Save { .. } => match self {
                Self::Full => None,
                Self::Forward | Self::Foreign => {
                    Some("this board is used by clients: what they do is not part of a test")
                }
                Self::Real => Some("what is done to a connected controller is not part of a test"),
            },
            PageRequest::Rate { .. }
            | PageRequest::Act { .. }
            | PageRequest::Command { .. }
            | PageRequest::Answer { .. }
            | PageRequest::Jog { .. }
            | PageRequest::Halt {}
            | PageRequest::Control { .. }
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

/// Returns whether a request only inspects the board, or stops it: read-only pages may do that.
pub(crate) const fn is_harmless(request: &PageRequest) -> bool {
    match request {
        PageRequest::Rate { .. }
        | PageRequest::Watch { .. }
        | PageRequest::Gather { .. }
        | PageRequest::Halt {}
        | PageRequest::Control { .. } => true,
        PageRequest::Run { .. }
        | PageRequest::Pause {}
        | PageRequest::Tick {}
        | PageRequest::Slice {}
        | PageRequest::Goto { .. }
        | PageRequest::Branch { .. }
        | PageRequest::Forget { .. }
        | PageRequest::Restart {}
        | PageRequest::Save { .. }
        | PageRequest::Act { .. }
        | PageRequest::Command { .. }
        | PageRequest::Answer { .. }
        | PageRequest::Jog { .. }
        | PageRequest::Start { .. }
        | PageRequest::Stop { .. }
        | PageRequest::Reload {}
        | PageRequest::Write { .. } => false,
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
            (TimeControl::Real, [false, false, true]),
        ] {
            assert_eq!([&back, &pause, &click].map(|request| control.allows(request).is_ok()), allowed);
        }
    }
}
