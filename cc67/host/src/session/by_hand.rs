//! Manual actions: the owner of a session acts as the world around the board, and as its PC.
//!
//! Each manual action is a statement of a stimulus at the beginning of the next tick. So the stimulus player executes
//! it, and the actions together are a stimulus: the same setup with that text repeats them, tick for tick. Actions that
//! no statement expresses are executed as well, and the recording notes that they are missing from it.

use std::fmt::Write as _;

use crate::target::Target;
use compiler::Options;
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use kmotiondef::{Bit, Cycles, ThreadId, Ticks};
use runtime::stimulus::{Stimulus, StimulusError};

use super::setup::resolve;
use super::{Input, Session, UserProgram};
use crate::HostError;
use crate::capability::Capability;

/// The name used in messages for the text of the statement.
const SOURCE: &str = "by hand";

/// The manual actions in a session.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recording {
    text: String,
    is_incomplete: bool,
    is_off: bool,
    /// The maximum number of bytes of the text; `None` for no limit.
    limit: Option<usize>,
}

impl Recording {
    /// The recording as a stimulus, one statement per line; actions without a statement are comments.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns whether the text contains all actions, so that a run with it is the same.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        !self.is_incomplete
    }

    /// Returns whether recording is off.
    pub(super) const fn is_off(&self) -> bool {
        self.is_off
    }

    /// Adds a statement, which is given without its time.
    fn add(&mut self, tick: Ticks, action: &str) {
        if self.is_off {
            self.is_incomplete = true;
        } else {
            // Writing to a string cannot fail.
            let _ = writeln!(self.text, "{}", statement(tick, action));
            self.end_at_limit(tick);
        }
    }

    /// Ends the recording when its text has reached the limit.
    fn end_at_limit(&mut self, tick: Ticks) {
        if let Some(limit) = self.limit.filter(|limit| self.text.len() >= *limit) {
            (self.is_off, self.is_incomplete) = (true, true);
            let end = statement(tick, "the recording ends");
            let _ = writeln!(self.text, "# {end}: it has {limit} bytes, and what was done later is missing");
        }
    }

    /// Adds that an element of `persist.UserData` was stored.
    pub(super) fn stored(&mut self, tick: Ticks, index: usize, value: i32) {
        self.add(tick, &format!("persist {index} = {value}"));
    }

    /// Adds an action that no statement expresses.
    pub(super) fn record_unsupported(&mut self, tick: Ticks, what: &str) {
        self.is_incomplete = true;
        if !self.is_off {
            let _ = writeln!(self.text, "# {}: no statement does this", statement(tick, what));
            self.end_at_limit(tick);
        }
    }
}

/// Formats an action as a statement for the start of the next tick.
fn statement(tick: Ticks, action: &str) -> String {
    let us = Cycles::PER_TICK.get() / (Cycles::PER_SECOND.get() / 1_000_000);
    format!("at {}us {action}", (tick.get() + 1).saturating_mul(us.unsigned_abs()))
}

/// Parses an action as a statement for the beginning of the tick after this one, with the names of these programs.
///
/// # Errors
/// The error, with the position of the character.
pub fn by_hand(
    tick: Ticks,
    action: &str,
    programs: &[UserProgram],
    options: &Options,
) -> Result<Stimulus, StimulusError> {
    let mut stimulus = Stimulus::parse(&statement(tick, action), SOURCE)?;
    resolve(&mut stimulus, programs, options)?;
    Ok(stimulus)
}

/// A byte string in quotation marks, as statements have it.
fn quoted(bytes: &[u8]) -> String {
    let mut text = String::from("\"");
    for &byte in bytes {
        match byte {
            b'"' | b'\\' => text.extend(['\\', char::from(byte)]),
            b' '..=b'~' => text.push(char::from(byte)),
            _ => {
                let _ = write!(text, "\\x{byte:02x}");
            }
        }
    }
    text + "\""
}

impl<T: Target> Session<T> {
    /// Returns the manual actions so far.
    #[must_use]
    pub const fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Stops recording manual actions, for a session without end.
    pub const fn stop_recording(&mut self) {
        self.recording.is_off = true;
    }

    /// Ends the recording of manual actions when its text has `bytes` bytes; a comment then says so.
    pub const fn limit_recording(&mut self, bytes: usize) {
        self.recording.limit = Some(bytes);
    }

    /// Executes a statement of a stimulus, such as `bit 136 = 1`, `adc 3 = 1500`, `pulse bit 137 for 50ms` or `encoder
    /// 0 moves 400 in 1s`, at the beginning of the next tick. The statement must not have a time of its own.
    ///
    /// # Errors
    /// The error, with the position of the character; nothing is executed then.
    ///
    /// ```
    /// let mut session = cc67_host::Setup::default().session()?;
    /// session.act("bit 136 = 1")?;
    /// session.step_tick(&mut |_| ());
    /// session.act("persist 7 = 11")?;
    /// session.step_tick(&mut |_| ());
    /// assert_eq!(session.user_data(7), Some(11));
    /// assert_eq!(session.recording().text(), "at 90us bit 136 = 1\nat 180us persist 7 = 11\n");
    /// assert!(session.act("bit 46 = 1").is_err());        // an output
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn act(&mut self, action: &str) -> Result<(), HostError> {
        let tick = self.tick();
        let stimulus = by_hand(tick, action, &self.programs, &self.options)?;
        self.require(Capability::Surroundings)?;
        self.target.play(stimulus);
        self.recording.add(tick, action);
        self.note(Input::Act(action.to_owned()));
        Ok(())
    }

    /// Sets the next answer of the PC, such as `msgbox=ok`: for a simulated board by a [statement](Self::act), for a
    /// connected one at once.
    ///
    /// # Errors
    /// The answer is not valid.
    pub fn answer(&mut self, setting: &str) -> Result<(), HostError> {
        match self.can(Capability::Answers) {
            true => self.target.answer(setting),
            false => self.act(&format!("answer {}", quoted(setting.as_bytes()))),
        }
    }

    /// Drives an input from outside at once.
    ///
    /// # Errors
    /// The bit is not an input: outputs are driven only by the board.
    pub fn drive_input(&mut self, bit: Bit, level: bool) -> Result<(), HostError> {
        let action = format!("bit {bit} = {}", u8::from(level));
        Stimulus::parse(&action, SOURCE)?;
        self.require(Capability::Surroundings)?;
        self.target.drive_input(bit, level);
        self.recording.add(self.target.tick(), &action);
        self.note(Input::Drive(bit, level));
        Ok(())
    }

    /// Stores an element of `persist.UserData` at once; returns `false` if there is no such element.
    pub fn set_user_data(&mut self, index: usize, value: i32) -> bool {
        let address = PERSIST.field(Persist::USER_DATA).element(index.min(N_USER_DATA_VARS - 1)).address();
        let address = self.target.place_of(address);
        let is_stored = index < N_USER_DATA_VARS && self.target.write(address, &value.to_le_bytes()).is_ok();
        if is_stored {
            self.recording.stored(self.target.tick(), index, value);
            self.note(Input::Store(address, value.to_le_bytes().into()));
        }
        is_stored
    }

    /// Sends a line of script commands, or a data line for which a command waits; the board takes it as time passes.
    pub fn command(&mut self, line: &[u8]) {
        let line: Vec<u8> = line.iter().copied().filter(|byte| *byte != b'\r').collect();
        self.receive(&[b"\x1b\x01", &line[..], b"\r"].concat());
    }

    /// Sends raw bytes over the USB link: lines that end with CR; a line that begins with 0x1B and another byte is not
    /// echoed.
    pub fn receive(&mut self, bytes: &[u8]) {
        self.target.receive(bytes);
        let tick = self.target.tick();
        match bytes {
            [0x1b, _, line @ .., b'\r'] if !line.contains(&b'\r') && line.is_ascii() => {
                self.recording.add(tick, &format!("command {}", quoted(line)));
            }
            _ => self.recording.record_unsupported(tick, &format!("send the bytes {}", quoted(bytes))),
        }
        self.note(Input::Receive(bytes.to_vec()));
    }

    /// Puts characters on the line to the serial port; they arrive one after another at its baud rate.
    pub fn send_to_uart(&mut self, bytes: &[u8]) {
        self.target.send_to_uart(bytes);
        self.recording.add(self.target.tick(), &format!("uart {}", quoted(bytes)));
        self.note(Input::Uart(bytes.to_vec()));
    }

    /// Starts a thread at its entry point, even if it is active.
    ///
    /// # Errors
    /// [`HostError::NotLoaded`].
    pub fn start(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.target.start(thread)?;
        self.recording.add(self.target.tick(), &format!("start {thread}"));
        self.note(Input::Start(thread));
        Ok(())
    }

    /// Pauses a thread while the others run ([`Capability::Pauses`]).
    ///
    /// # Errors
    /// The target cannot pause threads, or does not answer.
    pub fn pause(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.target.pause(thread)
    }

    /// Resumes a paused thread.
    ///
    /// # Errors
    /// As [`pause`](Self::pause).
    pub fn resume(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.target.resume(thread)
    }

    /// Stops a thread at its present position.
    pub fn stop(&mut self, thread: ThreadId) {
        self.target.stop(thread);
        self.recording.add(self.target.tick(), &format!("stop {thread}"));
        self.note(Input::Stop(thread));
    }

    /// From now on keeps the bytes that the board sends over its link, for a PC outside this process.
    pub fn tap_wire(&mut self) {
        self.target.tap_wire();
    }

    /// Takes the bytes sent over the link since the last call.
    pub fn take_wire(&mut self) -> Vec<u8> {
        self.target.take_wire()
    }

    /// Sets whether the PC takes console lines. If not, they wait in the board's queue, and once it is full, programs
    /// that print wait too.
    pub fn listen(&mut self, listens: bool) {
        self.target.listen(listens);
        if self.journal.listens() != listens {
            self.note(Input::Listen(listens));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_bytes_are_read_back_unchanged() {
        let all: Vec<u8> = (0..128).collect();
        let stimulus = Stimulus::parse(&format!("uart {}", quoted(&all)), SOURCE).expect("it is right");
        let action = stimulus.rules.into_iter().next().expect("a statement").action;
        assert_eq!(action, runtime::stimulus::Action::Uart(all));
    }

    #[test]
    fn a_recording_ends_at_its_limit_and_says_so() {
        let mut session = crate::Setup::default().session().expect("an empty board");
        session.limit_recording(100);
        for number in 0..50 {
            session.act(&format!("persist 7 = {number}")).expect("it is a statement");
        }
        let text = session.recording().text();
        assert!(text.lines().count() < 10 && text.len() < 300, "{text}");
        assert!(text.ends_with("it has 100 bytes, and what was done later is missing\n"), "{text}");
        assert!(!session.recording().is_complete() && Stimulus::parse(text, SOURCE).is_ok());
    }

    #[test]
    fn a_statement_takes_effect_at_the_start_of_the_next_tick() {
        for tick in [0, 1, 4999, 1_000_000_007] {
            let text = statement(Ticks::new(tick), "persist 1 = 2");
            let rule = Stimulus::parse(&text, SOURCE).expect("it is right").rules.remove(0);
            let begin = Cycles::new((tick as i64 + 1) * Cycles::PER_TICK.get());
            assert_eq!(rule.trigger, runtime::stimulus::Trigger::At(begin), "{text}");
        }
    }
}
