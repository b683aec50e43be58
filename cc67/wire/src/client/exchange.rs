//! Commands and their replies.

use std::time::Duration;

use super::refusals::Refusal;
use super::{ANSWER_WITHIN, Client};
use crate::clock::now;
use crate::error::WireError;
use crate::lines::Incoming;

/// The command at the end of each line: its reply shows that everything before it was executed.
const FENCE: &str = "Version";
/// The number of words of the gather buffer per line.
const WORDS_PER_LINE: u32 = 8;
/// Commands with data lines, which cannot be typed one by one.
const MULTI_LINE: [&str; 4] = ["LOADDATA", "LOADFLASH", "SETGATHERHEX", "READDISKDATA"];
/// The part of a name that all commands have which write flash.
const FLASH: &str = "FLASH";
/// The command that restarts the board; the board drops the rest of the line.
const RESTART: &str = "REBOOT!";

impl Client {
    /// Executes a command without a reply.
    ///
    /// # Errors
    /// The board rejects the command, or does not answer.
    pub fn command(&mut self, line: &str) -> Result<(), WireError> {
        self.send_line(line).map(drop)
    }

    /// Executes a command and returns its reply of one line.
    ///
    /// # Errors
    /// The board rejects the command, or does not answer.
    pub fn ask(&mut self, line: &str) -> Result<String, WireError> {
        let mut lines = self.ask_lines(line, 1)?;
        Ok(lines.pop().unwrap_or_default())
    }

    /// Executes a command and returns its reply of `count` lines.
    ///
    /// # Errors
    /// The board rejects the command, does not answer, or replies with fewer lines.
    pub fn ask_lines(&mut self, line: &str, count: usize) -> Result<Vec<String>, WireError> {
        let mut lines = self.send_line(line)?;
        let Some(foreign) = lines.len().checked_sub(count) else {
            return Err(self.unexpected(line, &lines.join(" / ")));
        };
        // The reply is at the end: the board executes both commands of the line without interruption.
        self.foreign_lines += foreign as u64;
        Ok(lines.split_off(foreign))
    }

    /// Executes a command line and returns all lines of its reply.
    ///
    /// # Errors
    /// The board rejects the line, or does not answer; the line writes flash, or needs data lines.
    pub fn send_line(&mut self, line: &str) -> Result<Vec<String>, WireError> {
        let upper = line.to_ascii_uppercase();
        if let Some(command) = MULTI_LINE.iter().find(|command| upper.contains(**command)) {
            return Err(WireError::NotBuilt {
                place: self.place().to_owned(),
                reason: format!("`{command}` needs further lines, which cannot be sent by hand"),
            });
        }
        if upper.contains(FLASH) {
            return Err(WireError::NotBuilt {
                place: self.place().to_owned(),
                reason: format!(
                    "`{line}` writes flash: `cc67 flash --on` saves to it, after it has shown what"
                ),
            });
        }
        if line.contains(['\r', '\n', '\x03']) {
            return Err(self.unexpected(line, "a command is one line"));
        }
        if upper.contains(RESTART) {
            self.restart(line)?;
            return Ok(Vec::new());
        }
        self.link.claim(ANSWER_WITHIN)?;
        let result = self.exchange(&[format!("{line};{FENCE}").into_bytes()], line, ANSWER_WITHIN);
        self.link.release();
        result
    }

    /// Restarts the board, and waits until it answers again.
    fn restart(&mut self, line: &str) -> Result<(), WireError> {
        self.link.claim(ANSWER_WITHIN)?;
        let sent = self.write(&[line.as_bytes().to_vec()]);
        self.link.release();
        sent?;
        self.handshake()
    }

    /// Reads words of the gather buffer.
    ///
    /// # Errors
    /// The board does not answer, or gives an unexpected answer.
    pub fn gather(&mut self, offset: u32, count: u32) -> Result<Vec<u32>, WireError> {
        let command = format!("GetGatherHex {offset} {count}");
        let lines = self.ask_lines(&command, count.div_ceil(WORDS_PER_LINE) as usize)?;
        let words = lines.iter().flat_map(|line| line.split_ascii_whitespace());
        let words = words.map(|word| u32::from_str_radix(word, 16).ok()).collect::<Option<Vec<_>>>();
        words
            .filter(|words| words.len() == count as usize)
            .ok_or_else(|| self.unexpected(&command, &lines.join(" / ")))
    }

    /// Stores words in the gather buffer.
    ///
    /// # Errors
    /// The board rejects them, or does not answer.
    pub fn set_gather(&mut self, offset: u32, words: &[u32]) -> Result<(), WireError> {
        let command = format!("SetGatherHex {offset} {}", words.len());
        let line =
            |words: &[u32]| words.iter().map(|word| format!("{word:08X}")).collect::<Vec<_>>().join(" ");
        let data = words.chunks(WORDS_PER_LINE as usize).map(|words| line(words).into_bytes());
        let mut lines: Vec<_> = std::iter::once(command.clone().into_bytes()).chain(data).collect();
        lines.push(FENCE.as_bytes().to_vec());
        self.link.claim(ANSWER_WITHIN)?;
        let result = self.exchange(&lines, &command, ANSWER_WITHIN);
        self.link.release();
        result.map(drop)
    }

    /// Sends lines, the last of which requests the version, and returns the lines of the replies before the version.
    pub(super) fn exchange(
        &mut self,
        lines: &[Vec<u8>],
        command: &str,
        within: Duration,
    ) -> Result<Vec<String>, WireError> {
        self.errors.watch();
        let sent = self.write(lines);
        let result = sent.and_then(|()| self.replies(command, within));
        self.errors.unwatch().into_iter().for_each(|line| self.keep(line));
        match result {
            Err(error @ WireError::NoAnswer { .. }) => {
                // The next command finds the board at the beginning of a line, unless the board is silent.
                self.resynchronise()?;
                Err(error)
            }
            result => result,
        }
    }

    /// The lines of the replies before that of the fence, or the board's rejection of our command.
    fn replies(&mut self, command: &str, within: Duration) -> Result<Vec<String>, WireError> {
        let mut lines = Vec::new();
        // The command itself may request the version.
        let mut fences = command.split(';').filter(|part| part.trim().eq_ignore_ascii_case(FENCE)).count();
        let mut end = now() + within;
        let mut unwritten = self.link.unwritten();
        loop {
            let item = self.next(end.min(now() + Duration::from_millis(200)))?;
            if let Some(refusal) = self.own_refusal(command) {
                return Err(refusal);
            }
            match item {
                Some(Incoming::Reply(line)) => {
                    let line = String::from_utf8_lossy(&line).into_owned();
                    if line == self.version && fences == 0 {
                        return Ok(lines);
                    }
                    fences -= usize::from(line == self.version);
                    lines.push(line);
                }
                Some(_) => {}
                None if now() >= end => return Err(self.no_answer(command, within)),
                None => {}
            }
            // A board that is still receiving data is not silent.
            let left = self.link.unwritten();
            if left < unwritten {
                unwritten = left;
                end = now() + within;
            }
        }
    }

    /// The error for a command of one line that the board rejects: it drops the rest of the line, including the fence.
    fn own_refusal(&self, command: &str) -> Option<WireError> {
        let upper = command.to_ascii_uppercase();
        let is_own = |refusal: &&Refusal| {
            refusal.command.is_empty() || upper.split(';').any(|part| part == refusal.command)
        };
        let refusal = self.errors.found().iter().find(is_own)?;
        Some(WireError::Refused { command: command.to_owned(), message: refusal.message.clone() })
    }

    /// The board's messages since the last command.
    pub(super) fn refusals(&self) -> &[Refusal] {
        self.errors.found()
    }

    pub(super) fn no_answer(&self, command: &str, within: Duration) -> WireError {
        WireError::NoAnswer {
            place: self.place().to_owned(),
            command: command.to_owned(),
            seconds: within.as_secs_f64(),
        }
    }
}
