//! The state of the board that is read periodically: its status record, and elements of `persist.UserData`.

use std::ops::Range;
use std::time::Duration;

use cc67_wire::Status;
use kmotiondef::limits::N_USER_DATA_VARS;
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::{PERSIST, chan};
use kmotiondef::{GuestAddr, ThreadId};
use runtime::RemoteBoard as _;

use super::Controller;
use crate::clock::now;
use crate::commands::Commands;

/// The interval at which the status record is read: 20 times per second.
const STATUS_EVERY: Duration = Duration::from_millis(50);

impl Controller {
    /// Processes a status record.
    pub(super) fn note_status(&mut self, status: Status) {
        for thread in ThreadId::all() {
            self.threads.note(thread, status.is_active(thread));
        }
        self.seen.note_status(&status);
        self.status = Some(status);
        self.is_fresh = true;
    }

    /// Reads the status record if it is due.
    pub(super) fn poll(&mut self) {
        if self.lost.is_some() || now() < self.time.next_status {
            return;
        }
        match self.client.get_mut().status() {
            Ok(status) => {
                let words = std::array::from_fn(|index| status.request(index));
                self.note_status(status);
                self.answer(words);
                if self.seen.take_look() {
                    self.read_elements();
                }
                self.read_samples();
            }
            Err(error) => self.note_error(&error),
        }
        // Keeps the rate, however long an exchange takes.
        self.time.next_status = (self.time.next_status + STATUS_EVERY).max(now());
    }

    /// Reads the velocities of the axes, for jog buttons.
    pub(super) fn read_velocities(&mut self) {
        let axes = self.seen.axes();
        let command = axes.iter().map(|axis| format!("Vel{axis}")).collect::<Vec<_>>().join(";");
        match self.client.get_mut().ask_lines(&command, axes.count()) {
            Ok(answers) => {
                for (axis, answer) in axes.iter().zip(answers) {
                    if let Ok(velocity) = answer.trim().parse::<f32>() {
                        let place = chan(axis).field(Chan::VEL).address();
                        self.seen.note(self.seen.place_of(place), &velocity.to_le_bytes());
                    }
                }
            }
            Err(error) => self.note_error(&error),
        }
    }

    /// Reads the next elements of `persist.UserData`, for readers of known memory.
    pub(super) fn read_elements(&mut self) {
        let elements = self.seen.next_elements();
        if elements.start == 0 {
            self.read_velocities();
        }
        match Commands(self.client.get_mut()).user_data(elements.start, elements.len()) {
            Ok(words) => {
                for (index, word) in elements.zip(words) {
                    self.seen.note(self.element_address(index), &word.to_le_bytes());
                }
            }
            Err(error) => self.note_error(&error),
        }
    }

    /// The address of an element of `persist.UserData` in the controller's firmware.
    pub(super) fn element_address(&self, index: usize) -> GuestAddr {
        self.seen.place_of(PERSIST.field(Persist::USER_DATA).element(index).address())
    }

    /// The elements of `persist.UserData` in a range of bytes; `None` if the range contains anything else.
    pub(super) fn elements(&self, address: GuestAddr, length: usize) -> Option<Range<usize>> {
        let offset = address.get().checked_sub(self.element_address(0).get())? as usize;
        let (first, end) = (offset / 4, offset / 4 + length / 4);
        let is_whole = offset.is_multiple_of(4) && length.is_multiple_of(4);
        (is_whole && end <= N_USER_DATA_VARS).then_some(first..end)
    }
}
