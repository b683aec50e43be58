//! A journal of the inputs to a session, each with the tick after which it was made, so that they can be repeated.

use std::sync::Arc;

use crate::target::Target;
use kmotiondef::{Bit, GuestAddr, ThreadId, Ticks};

use super::{Session, UserProgram};
use crate::HostError;

/// An action of a session's owner on the board.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A statement of a stimulus, without its time.
    Act(String),
    /// An input is driven from outside.
    Drive(Bit, bool),
    /// Bytes are stored at an address.
    Store(GuestAddr, Vec<u8>),
    /// Bytes come over the USB link.
    Receive(Vec<u8>),
    /// Characters are put on the line to the serial port.
    Uart(Vec<u8>),
    /// A thread is started.
    Start(ThreadId),
    /// A thread is stopped.
    Stop(ThreadId),
    /// Sets whether the PC takes console lines.
    Listen(bool),
    /// A program is loaded.
    Load(Box<UserProgram>),
}

/// All inputs to a session since its beginning, shared with its snapshots.
#[derive(Clone, Debug, Default)]
pub(super) struct Journal {
    entries: Arc<Vec<(Ticks, Input)>>,
    is_deaf: bool,
}

impl Journal {
    /// Adds an input that was made after a tick.
    pub(super) fn note(&mut self, tick: Ticks, input: Input) {
        if let Input::Listen(listens) = input {
            self.is_deaf = !listens;
        }
        Arc::make_mut(&mut self.entries).push((tick, input));
    }

    /// Returns whether the PC takes console lines.
    pub(super) const fn listens(&self) -> bool {
        !self.is_deaf
    }

    /// All inputs, in order.
    pub(super) fn entries(&self) -> &[(Ticks, Input)] {
        &self.entries
    }
}

impl<T: Target> Session<T> {
    /// All inputs to this session since its beginning, each with the tick after which it was made.
    #[must_use]
    pub fn journal(&self) -> &[(Ticks, Input)] {
        self.journal.entries()
    }

    /// Repeats an input of a journal now.
    ///
    /// # Errors
    /// The input cannot be repeated here: a bit that is not an input, a thread without a program, a program that is
    /// rejected.
    pub fn redo(&mut self, input: &Input) -> Result<(), HostError> {
        match input {
            Input::Act(action) => self.act(action)?,
            Input::Drive(bit, level) => self.drive_input(*bit, *level)?,
            Input::Store(address, bytes) => self.store(*address, bytes)?,
            Input::Receive(bytes) => self.receive(bytes),
            Input::Uart(bytes) => self.send_to_uart(bytes),
            Input::Start(thread) => self.start(*thread)?,
            Input::Stop(thread) => self.stop(*thread),
            Input::Listen(listens) => self.listen(*listens),
            Input::Load(program) => self.load(UserProgram::clone(program))?,
        }
        Ok(())
    }

    /// Stores bytes at an address.
    ///
    /// # Errors
    /// [`HostError::Unmapped`].
    pub fn store(&mut self, address: GuestAddr, bytes: &[u8]) -> Result<(), HostError> {
        self.target.write(address, bytes)?;
        let tick = self.tick();
        match (super::expression::user_data_at(address), <[u8; 4]>::try_from(bytes)) {
            (Some(index), Ok(word)) => self.recording.stored(tick, index, i32::from_le_bytes(word)),
            _ => {
                self.recording.record_unsupported(tick, &format!("store {} bytes at {address}", bytes.len()));
            }
        }
        self.note(Input::Store(address, bytes.to_vec()));
        Ok(())
    }

    /// Adds an input that was just made; has no effect in a session without a journal.
    pub(super) fn note(&mut self, input: Input) {
        if self.recording.is_off() {
            return;
        }
        self.journal.note(self.target.tick(), input);
    }
}
