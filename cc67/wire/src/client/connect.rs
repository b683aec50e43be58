//! The handshake. Source: wire.md sections 2.5 and 2.6.

use std::time::Duration;

use super::{ANSWER_WITHIN, Client};
use crate::clock::now;
use crate::error::WireError;
use crate::lines::Incoming;

/// Drops the line or download in progress; running programs continue.
const ABORT: &[u8] = b"\x03";
/// The number of attempts to reach a board that does not answer.
const ATTEMPTS: usize = 5;
/// The answer of a Kogna, a complete line of its console; the decoder recognises a KFLOP's answer.
const KOGNA_ANSWER: &[u8] = b"C";
/// The name of the Kogna in its version text.
const KOGNA: &str = "KOGNA";
/// The time limit for the answer to the abort byte.
const ABORTED_WITHIN: Duration = Duration::from_secs(1);

impl Client {
    /// Brings the board's command loop to the beginning of a line, and reads its version.
    pub(super) fn handshake(&mut self) -> Result<(), WireError> {
        self.link.claim(ANSWER_WITHIN)?;
        let result =
            (0..ATTEMPTS).try_fold(false, |is_done, _| if is_done { Ok(true) } else { self.abort() });
        let result = result.and_then(|is_done| {
            if is_done {
                self.read_version()
            } else {
                Err(WireError::Silent { place: self.place().to_owned() })
            }
        });
        self.link.release();
        result
    }

    /// Sends the abort byte; returns whether it was answered. Lines before the answer belong to other clients.
    fn abort(&mut self) -> Result<bool, WireError> {
        self.link.send(ABORT.to_vec())?;
        let end = now() + ABORTED_WITHIN;
        while let Some(item) = self.next(end)? {
            if item == Incoming::Aborted || self.is_answer_of_kogna(&item) {
                return Ok(true);
            }
            if now() >= end {
                break;
            }
        }
        Ok(false)
    }

    /// Returns whether a Kogna has answered the abort byte. Before the version is known, any board may be one: a
    /// console line of a KFLOP that looks like the answer does no harm, as the version is requested next.
    fn is_answer_of_kogna(&mut self, item: &Incoming) -> bool {
        let may_be_kogna = self.version.is_empty() || self.version.contains(KOGNA);
        let is_answer = may_be_kogna && matches!(item, Incoming::Console(line) if line == KOGNA_ANSWER);
        if is_answer && !self.version.is_empty() {
            self.console.pop_back();
        }
        is_answer
    }

    fn read_version(&mut self) -> Result<(), WireError> {
        self.write(&[b"Version".to_vec()])?;
        let end = now() + ANSWER_WITHIN;
        while let Some(item) = self.next(end)? {
            let Incoming::Reply(line) = item else { continue };
            let line = String::from_utf8_lossy(&line).into_owned();
            // Other lines are left over from another client.
            if line.contains(" Build ") {
                if line.contains(KOGNA) {
                    self.console.retain(|line| line != KOGNA_ANSWER);
                }
                self.version = line;
                return Ok(());
            }
        }
        Err(self.no_answer("Version", ANSWER_WITHIN))
    }

    /// Resynchronises with the board after a missing answer: pending input and output are dropped.
    pub(super) fn resynchronise(&mut self) -> Result<(), WireError> {
        if self.abort()? { Ok(()) } else { Err(WireError::Silent { place: self.place().to_owned() }) }
    }
}
