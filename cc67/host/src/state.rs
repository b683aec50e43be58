//! The board and its single link, which all clients share.

use std::collections::VecDeque;
use std::fmt;
use std::mem;

use kmotiondef::{Cycles, Field, Plain, Scalar, Ticks};
use runtime::{Event, EventKind, Message, Remark, Speaker};

use crate::session::{EXCHANGE, ticks};
use crate::target::CONSOLE_LINES;
use crate::target::Target as _;
use crate::{AnyTarget, HostError, Session, remark};

/// The size of the reply buffer; further bytes are lost.
pub const REPLY_BYTES: usize = 1 << 20;
/// The number of remarks that are kept; older ones are dropped.
const REMARK_LIMIT: usize = 1000;

/// The receiver of console lines.
pub(super) type Callback = Box<dyn FnMut(&str) + Send>;

/// The status record of the board, `MAIN_STATUS`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Status(Vec<u8>);

/// The size of the record in bytes.
const STATUS_SIZE: usize = 464;

impl Status {
    /// A field of the record.
    ///
    /// ```
    /// use cc67_host::Board;
    /// use kmotiondef::structs::MainStatus;
    ///
    /// let status = Board::new().get_status()?;
    /// assert_eq!(status.get(MainStatus::THREAD_ACTIVE), 1);
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    #[must_use]
    pub fn get<T: Scalar>(&self, field: Field<T>) -> T::Value {
        let bytes = self.0.iter().skip(field.offset() as usize).take(T::SIZE as usize);
        let bits = bytes.rev().fold(0_u64, |bits, byte| bits << 8 | u64::from(*byte));
        T::Value::from_bits(bits)
    }

    /// The record as it is laid out in the memory of a PC.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.0
    }
}

/// The board, its link, and the data received over it.
pub(super) struct State {
    pub(super) session: Session<AnyTarget>,
    pub(super) is_locked: bool,
    pub(super) is_connected: bool,
    /// Bytes of replies that have not been read yet.
    incoming: VecDeque<u8>,
    /// True if the loss of entries has been reported.
    has_told_loss: bool,
    console: VecDeque<String>,
    callback: Option<(u64, Callback)>,
    remarks: VecDeque<Event>,
    clients: u64,
}

impl fmt::Debug for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("State").field("is_locked", &self.is_locked).finish_non_exhaustive()
    }
}

impl State {
    pub(super) fn new(mut session: Session<AnyTarget>) -> Self {
        session.stop_recording();
        Self {
            session,
            is_locked: false,
            is_connected: true,
            incoming: VecDeque::new(),
            has_told_loss: false,
            console: VecDeque::new(),
            callback: None,
            remarks: VecDeque::new(),
            clients: 0,
        }
    }

    /// A number for a new client.
    pub(super) fn number(&mut self) -> u64 {
        self.clients += 1;
        self.clients
    }

    pub(super) fn set_callback(&mut self, client: u64, callback: Callback) {
        self.callback = Some((client, callback));
    }

    /// Removes the call-back of a client that has been dropped.
    pub(super) fn drop_callback(&mut self, client: u64) {
        self.callback.take_if(|(owner, _)| *owner == client);
    }

    /// Takes the remarks of the simulation since the last call.
    pub(super) fn take_remarks(&mut self) -> Vec<Event> {
        mem::take(&mut self.remarks).into()
    }

    /// The next remark as text.
    pub(super) fn take_remark(&mut self) -> Option<String> {
        let programs: Vec<_> = self.session.debug().into_iter().map(|(_, debug)| debug).collect();
        std::iter::from_fn(|| self.remarks.pop_front()).find_map(|event| remark::describe(&event, &programs))
    }

    /// Returns an error if the connection was closed or lost.
    pub(super) fn connected(&self) -> Result<(), HostError> {
        if self.is_connected && !self.is_lost() { Ok(()) } else { Err(HostError::NotConnected) }
    }

    /// Returns whether the controller cannot be reached any more.
    pub(super) fn is_lost(&self) -> bool {
        self.session.target().loss_reason().is_some()
    }

    /// Connects again: data in transit are dropped.
    pub(super) fn connect(&mut self) {
        self.is_connected = true;
        self.incoming.clear();
        self.send(b"\x03");
        self.advance(EXCHANGE, &mut |_| false);
    }

    /// Sends bytes to the board.
    pub(super) fn send(&mut self, bytes: &[u8]) {
        self.session.receive(bytes);
    }

    /// Sends a line and lets the board take it.
    pub(super) fn send_line(&mut self, bytes: &[u8]) {
        self.send(bytes);
        self.advance(ticks(1.0), &mut |state| !state.session.target().is_receiving());
    }

    /// The next line of a reply, with its line end, if it comes within a number of ticks.
    pub(super) fn read_line(&mut self, limit: u64) -> Option<String> {
        self.advance(limit, &mut |state| state.has_line());
        self.take_line()
    }

    fn has_line(&self) -> bool {
        self.incoming.contains(&b'\n')
    }

    fn take_line(&mut self) -> Option<String> {
        let end = self.incoming.iter().position(|byte| *byte == b'\n')?;
        let line: Vec<u8> = self.incoming.drain(..=end).collect();
        Some(String::from_utf8_lossy(&line).into_owned())
    }

    /// Returns whether a part of a line has arrived.
    pub(super) fn has_partial_line(&self) -> bool {
        !self.incoming.is_empty()
    }

    /// The next waiting console line.
    pub(super) fn take_console(&mut self) -> Option<String> {
        self.console.pop_front()
    }

    /// Returns whether a console line waits.
    pub(super) fn has_console(&self) -> bool {
        !self.console.is_empty()
    }

    /// Runs for a number of ticks, or until `is_over` returns true after one of them; returns whether it did.
    pub(super) fn advance(&mut self, count: u64, is_over: &mut dyn FnMut(&mut Self) -> bool) -> bool {
        if is_over(self) {
            return true;
        }
        let end = Ticks::new(self.session.tick().get().saturating_add(count));
        while self.session.tick() < end {
            self.step(end);
            if is_over(self) {
                return true;
            }
        }
        false
    }

    /// Runs to the end of the next tick in which something happens, and takes the data from the link.
    fn step(&mut self, end: Ticks) {
        self.session.listen(self.callback.is_some() || self.console.len() < CONSOLE_LINES);
        let mut events = Vec::new();
        self.session.step(end, &mut |event| events.push(event));
        for event in events {
            self.take(event);
        }
    }

    fn take(&mut self, event: Event) {
        match event.kind {
            EventKind::Reply(_) | EventKind::Echo(_) if self.incoming.len() >= REPLY_BYTES => {
                self.tell_loss(event.at);
            }
            EventKind::Reply(line) => self.incoming.extend(line.iter().chain(b"\r\n")),
            EventKind::Echo(bytes) => self.incoming.extend(bytes),
            EventKind::Aborted => self.incoming.clear(),
            EventKind::ConsoleLine(line) => {
                let line = String::from_utf8_lossy(&line).into_owned();
                match &mut self.callback {
                    Some((_, callback)) => callback(&line),
                    None => self.console.push_back(line),
                }
            }
            _ => self.remark(event),
        }
    }

    fn remark(&mut self, event: Event) {
        if self.remarks.len() == REMARK_LIMIT {
            self.remarks.pop_front();
        }
        self.remarks.push_back(event);
    }

    /// Reports once that no client reads the replies.
    fn tell_loss(&mut self, at: Cycles) {
        if !std::mem::replace(&mut self.has_told_loss, true) {
            let message = Message::RepliesLost { bytes: REPLY_BYTES };
            let remark = Remark { message, speaker: Speaker::Board, place: None };
            self.remark(Event { at, kind: EventKind::Remark(remark) });
        }
    }

    /// Reads the lines of a status record.
    pub(super) fn read_status(&mut self) -> Option<Status> {
        let mut bytes = Vec::new();
        while bytes.len() < STATUS_SIZE {
            let line = self.read_line(ticks(5.0))?;
            for word in line.split_whitespace() {
                bytes.extend_from_slice(&u32::from_str_radix(word, 16).ok()?.to_le_bytes());
            }
        }
        Some(Status(bytes))
    }
}
