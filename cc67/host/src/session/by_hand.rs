//! Manual actions: the owner of a session acts as the world around the board, and as its PC.
//!
//! Whatever a person does is a statement of a stimulus at the beginning of the next tick. So it is done by what plays
//! stimuli, and what was done is a stimulus: the same setup with that text does it all again, tick for tick. What no
//! statement says is done as well, and the recording says that it lacks it.

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

/// The name of the statement's text in messages.
const SOURCE: &str = "by hand";

/// The actions by hand in a session.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Recording {
    text: String,
    is_incomplete: bool,
    is_off: bool,
    /// Most bytes of the text; `None` without a limit.
    limit: Option<usize>,
}

impl Recording {
    /// All of it as a stimulus, a statement a line; actions without a statement are comments.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns whether the text has all actions, so that a run with it is the same.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        !self.is_incomplete
    }

    /// Returns whether recording is off.
    pub(super) const fn is_off(&self) -> bool {
        self.is_off
    }

    /// Adds a statement without its moment.
    fn add(&mut self, tick: Ticks, action: &str) {
        if self.is_off {
            self.is_incomplete = true;
        } else {
            // Writing to a string cannot fail.
            let _ = writeln!(self.text, "{}", statement(tick, action));
            self.end_at_limit(tick);
        }
    }

    /// Ends the recording when its text is as long as it may be.
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

    /// Adds an action that has no statement.
    pub(super) fn cannot(&mut self, tick: Ticks, what: &str) {
        self.is_incomplete = true;
        if !self.is_off {
            let _ = writeln!(self.text, "# {}: no statement does this", statement(tick, what));
            self.end_at_limit(tick);
        }
    }
}

/// Formats an action as a statement at the start of the next tick.
fn statement(tick: Ticks, action: &str) -> String {
    let us = Cycles::PER_TICK.get() / (Cycles::PER_SECOND.get() / 1_000_000);
    format!("at {}us {action}", (tick.get() + 1).saturating_mul(us.unsigned_abs()))
}

/// Reads an action as a statement for the beginning of the tick after this one, with the names of these programs.
///
/// # Errors
/// What is wrong with it, and at which character.
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

/// Bytes between quotation marks, as statements have them.
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
    /// Returns the actions by hand so far.
    #[must_use]
    pub const fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Keeps no account of what is done by hand from now on, for a session without end.
    pub const fn stop_recording(&mut self) {
        self.recording.is_off = true;
    }

    /// Ends the account of what is done by hand when its text has `bytes` bytes; a comment then says so.
    pub const fn limit_recording(&mut self, bytes: usize) {
        self.recording.limit = Some(bytes);
    }

    /// Executes a statement of a stimulus, such as `bit 136 = 1`, `adc 3 = 1500`, `pulse bit 137 for 50ms` or `encoder
    /// 0 moves 400 in 1s`, at the beginning of the next tick. The statement has no moment of its own.
    ///
    /// # Errors
    /// What is wrong with it, and at which character; nothing happens then.
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

    /// Gives the PC its next answer, such as `msgbox=ok`: of a simulated board by a [statement](Self::act), of a connected
    /// one at once.
    ///
    /// # Errors
    /// The answer is wrong.
    pub fn answer(&mut self, setting: &str) -> Result<(), HostError> {
        match self.can(Capability::Answers) {
            true => self.target.answer(setting),
            false => self.act(&format!("answer {}", quoted(setting.as_bytes()))),
        }
    }

    /// Drives an input from outside at once.
    ///
    /// # Errors
    /// What is wrong with the bit: only the board drives an output.
    pub fn drive_input(&mut self, bit: Bit, level: bool) -> Result<(), HostError> {
        let action = format!("bit {bit} = {}", u8::from(level));
        Stimulus::parse(&action, SOURCE)?;
        self.require(Capability::Surroundings)?;
        self.target.drive_input(bit, level);
        self.recording.add(self.target.tick(), &action);
        self.note(Input::Drive(bit, level));
        Ok(())
    }

    /// Stores an element of `persist.UserData` at once; `false` beyond the last.
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

    /// Sends a line of script commands, or a data line that a command waits for; the board takes it as time passes.
    pub fn command(&mut self, line: &[u8]) {
        let line: Vec<u8> = line.iter().copied().filter(|byte| *byte != b'\r').collect();
        self.receive(&[b"\x1b\x01", &line[..], b"\r"].concat());
    }

    /// Sends bytes over the USB link as they are: lines, ended by CR; one that begins with 0x1B and another byte is not
    /// echoed.
    pub fn receive(&mut self, bytes: &[u8]) {
        self.target.receive(bytes);
        let tick = self.target.tick();
        match bytes {
            [0x1b, _, line @ .., b'\r'] if !line.contains(&b'\r') && line.is_ascii() => {
                self.recording.add(tick, &format!("command {}", quoted(line)));
            }
            _ => self.recording.cannot(tick, &format!("send the bytes {}", quoted(bytes))),
        }
        self.note(Input::Receive(bytes.to_vec()));
    }

    /// Puts characters on the line to the serial port; they arrive one after another at its rate.
    pub fn send_to_uart(&mut self, bytes: &[u8]) {
        self.target.send_to_uart(bytes);
        self.recording.add(self.target.tick(), &format!("uart {}", quoted(bytes)));
        self.note(Input::Uart(bytes.to_vec()));
    }

    /// Starts a thread at its entry point, also if it is active.
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
    /// The target cannot, or does not answer.
    pub fn pause(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.target.pause(thread)
    }

    /// Lets a paused thread continue.
    ///
    /// # Errors
    /// As [`pause`](Self::pause).
    pub fn resume(&mut self, thread: ThreadId) -> Result<(), HostError> {
        self.target.resume(thread)
    }

    /// Stops a thread where it is.
    pub fn stop(&mut self, thread: ThreadId) {
        self.target.stop(thread);
        self.recording.add(self.target.tick(), &format!("stop {thread}"));
        self.note(Input::Stop(thread));
    }

    /// Keeps from now on the bytes that the board sends over its link, for a PC that is elsewhere.
    pub fn tap_wire(&mut self) {
        self.target.tap_wire();
    }

    /// Takes the bytes of the link since the last call.
    pub fn take_wire(&mut self) -> Vec<u8> {
        self.target.take_wire()
    }

    /// Says whether the PC takes console lines. If not, they wait in the board's queue, and once that is full, so do the
    /// programs that print.
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
