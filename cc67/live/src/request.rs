//! Requests of pages: one JSON object per message.

use serde::Deserialize;

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum PageRequest {
    /// Send this many frames per second, at most 60; 0 for none.
    Rate {
        /// Frames per second.
        frames: f64,
    },
    /// Let the board run at this many seconds of board time per second.
    Run {
        /// 0.01 to 100; unchanged if absent.
        speed: Option<f64>,
    },
    /// Stop the clock.
    Pause {},
    /// Run one tick.
    Tick {},
    /// Run to the end of the next slice of a user thread.
    Slice {},
    /// Execute a statement of a stimulus.
    Act {
        /// The statement, without a time.
        text: String,
    },
    /// Send a line of script commands, as the PC does.
    Command {
        /// The line.
        line: String,
    },
    /// Jog an axis for as long as this request is repeated within 0.4 s; a velocity of 0 ends the jog.
    Jog {
        /// 0 to 7.
        axis: i32,
        /// Counts or steps per second.
        velocity: f64,
    },
    /// Stop all threads and disable all axes.
    Halt {},
    /// Allow pages to control a connected controller, or only to watch it.
    Control {
        /// True to allow it.
        on: bool,
    },
    /// Start a thread.
    Start {
        /// 1 to 7.
        thread: i32,
    },
    /// Stop a thread.
    Stop {
        /// 1 to 7.
        thread: i32,
    },
    /// Answer the box that a program has opened.
    Answer {
        /// A button or a number: `msgbox=ok`, `input=2.5`, `input=cancel`.
        setting: String,
    },
    /// Compile the changed programs, load and start them.
    Reload {},
    /// Sample these signals.
    Watch {
        /// The list, separated by commas.
        list: String,
    },
    /// Show the board as it was at a tick; the next action continues from there.
    Goto {
        /// The tick.
        tick: u64,
    },
    /// Return to a line of history that was left.
    Branch {
        /// Its number.
        id: u64,
    },
    /// Drop a line of history that was left.
    Forget {
        /// Its number.
        id: u64,
    },
    /// Restart the board.
    Restart {},
    /// Save the manual actions as a test.
    Save {
        /// Its name.
        name: String,
    },
    /// Show a part of the gather buffer.
    Gather {
        /// The index of the first value, in units of this kind.
        from: u32,
        /// The number of values, at most 10,000.
        count: u32,
        /// `double`, `float` or `int`.
        kind: String,
    },
    /// Store a value in a variable.
    Write {
        /// The variable, as an expression of a program.
        expression: String,
        /// The value.
        value: f64,
    },
}

/// The maximum length of a request.
pub(crate) const LONGEST: usize = 16 << 10;

impl PageRequest {
    /// Parses a request.
    pub(crate) fn parse(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_an_object_with_a_known_action() {
        let parsed = PageRequest::parse(r#"{"do":"act","text":"bit 136 = 1"}"#).expect("it is one");
        assert_eq!(parsed, PageRequest::Act { text: "bit 136 = 1".to_owned() });
        assert_eq!(
            PageRequest::parse(r#"{"do":"run"}"#).expect("speed may be absent"),
            PageRequest::Run { speed: None }
        );
        for wrong in [
            "",
            "{}",
            "[]",
            r#"{"do":"fly"}"#,
            r#"{"do":"tick","more":1}"#,
            r#"{"do":"start"}"#,
            r#"{"do":"control"}"#,
        ] {
            assert!(PageRequest::parse(wrong).is_err(), "{wrong}");
        }
    }
}
