//! Saving to flash. Source: dsp-board.md section 2.4.

use std::time::Duration;

use kmotiondef::ThreadId;

use super::Client;
use crate::clock::now;
use crate::error::WireError;

/// The command that saves memory to flash.
const SAVE: &str = "Flash";
/// The reply after saving, and the console line after the board has compared flash with memory.
const SAVED: &str = "Program Flash Image Complete";
const VERIFIED: &[u8] = b"Verify Complete";
/// The time limit: the board takes about 7 s, during which only its servo continues.
const SAVED_WITHIN: Duration = Duration::from_secs(60);
const VERIFIED_WITHIN: Duration = Duration::from_secs(20);
/// The interval at which the console is checked.
const POLL: Duration = Duration::from_millis(200);

impl Client {
    /// Sets whether a thread starts automatically at power-up, after the next [`save_to_flash`](Self::save_to_flash).
    ///
    /// # Errors
    /// The board does not answer.
    pub fn set_startup(&mut self, thread: ThreadId, starts: bool) -> Result<(), WireError> {
        self.command(&format!("SetStartupThread{thread} {}", u8::from(starts)))
    }

    /// Saves programs, `persist`, axes and coordinate system to the flash from which the board starts, and waits until
    /// the board has verified it. The contents of the gather buffer are lost.
    ///
    /// # Errors
    /// The board does not answer, or does not confirm both steps.
    pub fn save_to_flash(&mut self) -> Result<(), WireError> {
        self.link.claim(SAVED_WITHIN)?;
        let replies = self.exchange(&[format!("{SAVE};Version").into_bytes()], SAVE, SAVED_WITHIN);
        self.link.release();
        let replies = replies?;
        if replies.iter().any(|line| line == SAVED) && self.wait_for_line(VERIFIED)? {
            return Ok(());
        }
        let lines = self.console.iter().map(|line| String::from_utf8_lossy(line).into_owned());
        let said: Vec<_> = replies.iter().cloned().chain(lines).collect();
        Err(self.unexpected(SAVE, &said.join(" / ")))
    }

    /// Waits for a console line and takes it; returns whether it came.
    fn wait_for_line(&mut self, wanted: &[u8]) -> Result<bool, WireError> {
        let end = now() + VERIFIED_WITHIN;
        loop {
            if let Some(at) = self.console.iter().position(|line| line == wanted) {
                self.console.remove(at);
                return Ok(true);
            }
            if now() >= end {
                return Ok(false);
            }
            self.service(end.saturating_duration_since(now()).min(POLL))?;
        }
    }
}
