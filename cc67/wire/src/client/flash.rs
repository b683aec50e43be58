//! Saving to flash. Source: dsp-board.md section 2.4.

use std::time::Duration;

use kmotiondef::ThreadId;

use super::Client;
use crate::clock::now;
use crate::error::WireError;

/// The command that saves memory to flash.
const SAVE: &str = "Flash";
/// The reply when it is done, and the console line when the board has compared flash with memory.
const SAVED: &str = "Program Flash Image Complete";
const VERIFIED: &[u8] = b"Verify Complete";
/// The board takes about 7 s; only its servo continues meanwhile.
const SAVED_WITHIN: Duration = Duration::from_secs(60);
const VERIFIED_WITHIN: Duration = Duration::from_secs(20);
/// Pause between two looks at the console.
const POLL: Duration = Duration::from_millis(200);

impl Client {
    /// Sets whether a thread starts by itself at power-up; it counts from the next [`save_to_flash`](Self::save_to_flash) on.
    ///
    /// # Errors
    /// The board does not answer.
    pub fn set_startup(&mut self, thread: ThreadId, starts: bool) -> Result<(), WireError> {
        self.command(&format!("SetStartupThread{thread} {}", u8::from(starts)))
    }

    /// Saves programs, `persist`, axes and coordinate system to the flash that the board starts from, and waits until the
    /// board has compared it. The gather buffer is lost.
    ///
    /// # Errors
    /// The board does not answer, or does not say that both are done.
    pub fn save_to_flash(&mut self) -> Result<(), WireError> {
        self.link.claim(SAVED_WITHIN)?;
        let replies = self.exchange(&[format!("{SAVE};Version").into_bytes()], SAVE, SAVED_WITHIN);
        self.link.release();
        let replies = replies?;
        if replies.iter().any(|line| line == SAVED) && self.hears(VERIFIED)? {
            return Ok(());
        }
        let lines = self.console.iter().map(|line| String::from_utf8_lossy(line).into_owned());
        let said: Vec<_> = replies.iter().cloned().chain(lines).collect();
        Err(self.unexpected(SAVE, &said.join(" / ")))
    }

    /// Waits for a console line and takes it; returns whether it has come.
    fn hears(&mut self, wanted: &[u8]) -> Result<bool, WireError> {
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
