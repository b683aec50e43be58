//! The log of the exchanges: the requests of clients, as a script for `cc67 console`.
//!
//! A line for the board is a line of the script; `wait` lets the time between two of them pass; everything else is a
//! comment. So `cc67 console PROGRAM < LOG` repeats the requests to the same board.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Result;
use cc67_host::session::EXCHANGE;
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

use super::super::console::ACTIONS;
use crate::cli::io::output::cannot_write;
use crate::cli::io::terminal;

/// A file that grows with each exchange; it is not buffered, so that it is complete even if the server is killed.
#[derive(Debug)]
pub(super) struct ExchangeLog {
    path: PathBuf,
    /// `None` once a write has failed.
    file: Option<File>,
    /// The tick that the script has reached.
    reached: u64,
}

impl ExchangeLog {
    /// Begins a log.
    pub(super) fn new(path: &Path) -> Result<Self> {
        let file = File::create(path).map_err(|error| cannot_write(path, &error))?;
        Ok(Self { path: path.to_owned(), file: Some(file), reached: 0 })
    }

    /// Logs a line to the board: a command, or data of the command in progress.
    pub(super) fn line(&mut self, tick: Ticks, line: &[u8], is_data: bool) {
        let mut text = Vec::new();
        if !is_data {
            text.extend(self.pause(tick).into_bytes());
            self.reached += EXCHANGE;
        }
        // The board ignores case, while the console's own words are in lower case.
        text.extend(line.iter().map(u8::to_ascii_uppercase).filter(|byte| *byte != b'\n'));
        text.push(b'\n');
        self.write(&text);
    }

    /// The console commands that let time pass until a tick.
    fn pause(&mut self, tick: Ticks) -> String {
        let pause = tick.get().saturating_sub(self.reached);
        self.reached += pause;
        if pause == 0 { String::new() } else { format!("wait {:.6}\n", pause as f64 * TIMEBASE) }
    }

    /// Logs an action of a page on the world around the board: a statement of a stimulus. Actions without a console
    /// command become comments.
    pub(super) fn act(&mut self, tick: Ticks, act: &str, is_in_command: bool) {
        let is_word = |word: &str| ACTIONS.contains(&word);
        if is_in_command || !act.split(' ').next().is_some_and(is_word) {
            return self.remark(tick, &format!("page: {act}"), is_in_command);
        }
        let text = format!("{}{act}\n", self.pause(tick));
        self.write(text.as_bytes());
    }

    /// Logs a remark as a comment, or drops it inside a command, whose data lines must be contiguous.
    pub(super) fn remark(&mut self, tick: Ticks, text: &str, is_in_command: bool) {
        if !is_in_command {
            let seconds = tick.get() as f64 * TIMEBASE;
            self.write(format!("# {seconds:.6} {}\n", text.replace(['\r', '\n'], " ")).as_bytes());
        }
    }

    fn write(&mut self, bytes: &[u8]) {
        let Some(file) = &mut self.file else { return };
        if let Err(error) = file.write_all(bytes) {
            terminal::error(&cannot_write(&self.path, &error).context("the log ends here"));
            self.file = None;
        }
    }
}
