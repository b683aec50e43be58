//! A board that runs the user's own firmware file (`--boot FILE`): programs compiled for the real processor and linked
//! against that file, board time, and what the firmware sends as events.
//!
//! Time is counted from the moment in which the firmware has started and looks for the first byte of the PC.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result};
use boot::{BootedBoard, BootedSnapshot, FirmwareFile, Halted, Line, Sent};
use cc67_host::End;
use compiler::Options;
use compiler::firmware::{Firmware, FirmwareFile as Symbols};
use compiler::target::Target;
use kmotiondef::variables::PERSIST;
use kmotiondef::{AxisId, Cycles, ThreadId, Ticks};
use runtime::{Event, EventKind};

use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::program::ProgramFile;
use crate::cli::args::setting::Setting;
use crate::cli::compile::images;
use crate::cli::io::input::read;

/// Cycles of a tick, and of a second.
const TICK: u64 = Cycles::PER_TICK.get() as u64;
const SECOND: u64 = Cycles::PER_SECOND.get() as u64;
/// Ticks without a byte and without motion after which nothing more is to come.
const QUIET: u32 = 22;
/// Longest time for which the answer to a line is waited for: a command of many lines sends all the while.
const ANSWER: u64 = 2 * SECOND;

/// The board, and what programs for it are linked against.
#[derive(Debug)]
pub(crate) struct Booted {
    /// The board.
    pub(crate) board: BootedBoard,
    firmware: Firmware,
    origin: u64,
}

/// A firmware that has started, to run programs on again and again from there.
#[derive(Debug)]
pub(crate) struct Ready {
    booted: Option<Booted>,
    snapshot: BootedSnapshot,
    firmware: Firmware,
}

impl Ready {
    /// The board as it was when the firmware was ready.
    pub(crate) fn fresh(&mut self) -> Booted {
        let origin = self.snapshot.cycle();
        let mut booted = self.booted.take().unwrap_or_else(|| Booted {
            board: self.snapshot.board(),
            firmware: self.firmware.clone(),
            origin,
        });
        booted.board.restore(&self.snapshot);
        booted
    }

    /// The board is free for the next run.
    pub(crate) fn take_back(&mut self, booted: Booted) {
        self.booted = Some(booted);
    }
}

impl Booted {
    /// Keeps the board as it is now.
    pub(crate) fn into_ready(mut self) -> Ready {
        let (snapshot, firmware) = (self.board.snapshot(), self.firmware.clone());
        Ready { booted: Some(self), snapshot, firmware }
    }

    /// Starts a firmware file.
    pub(crate) fn new(path: &Path) -> Result<Self> {
        let bytes = read(path)?;
        let shown = || format!("`--boot {}`", path.display());
        let file = FirmwareFile::read(&bytes).with_context(shown)?;
        let symbols = Symbols::read(&bytes).with_context(shown)?;
        let board = BootedBoard::booted(Arc::new(file)).with_context(shown)?;
        let origin = board.cycle();
        Ok(Self { board, firmware: Firmware::File(Arc::new(symbols)), origin })
    }

    /// Compiles and loads programs, and starts the first of them; whether their sources have no errors.
    pub(crate) fn load(
        &mut self,
        files: &[ProgramFile],
        starts: usize,
        compiler: &CompilerArguments,
    ) -> Result<bool> {
        let options =
            Options { target: Target::C67x, firmware: self.firmware.clone(), ..compiler.resolve()? };
        let Some(programs) = images::programs_with(files, compiler, &options)? else { return Ok(false) };
        for program in &programs {
            let loaded = self.board.load_program(program.thread, &program.image);
            loaded.with_context(|| program.path.display().to_string())?;
        }
        programs.iter().take(starts).for_each(|program| self.board.execute(program.thread));
        Ok(true)
    }

    /// Stores start values of `persist.UserData`, wherever this firmware has it.
    pub(crate) fn store(&mut self, values: &[Setting]) -> Result<()> {
        let persist = self.board.file().address("persist").context("this firmware has no `persist`")?;
        for Setting { address, bytes } in values {
            let place = persist.offset(address.get() - PERSIST.address().get());
            self.board.memory_mut().poke_bytes(place, bytes)?;
        }
        Ok(())
    }

    /// Board time since the firmware was ready.
    pub(crate) fn now(&self) -> Cycles {
        self.since_ready(self.board.cycle())
    }

    /// The same in ticks.
    pub(crate) fn tick(&self) -> Ticks {
        Ticks::new((self.board.cycle() - self.origin) / TICK)
    }

    fn since_ready(&self, cycle: u64) -> Cycles {
        Cycles::new(i64::try_from(cycle.saturating_sub(self.origin)).unwrap_or(i64::MAX))
    }

    /// The user threads that are active.
    pub(crate) fn active(&self) -> Vec<u8> {
        let is_active = |thread: &ThreadId| self.board.is_active(*thread).unwrap_or(false);
        ThreadId::all().filter(is_active).map(ThreadId::get).collect()
    }

    /// Runs until everything has ended, or for that long since the firmware was ready.
    ///
    /// # Errors
    /// The firmware ran away; what it has sent before was handed over.
    pub(crate) fn run(&mut self, limit: Ticks, sink: &mut dyn FnMut(Event)) -> Result<End, Halted> {
        let mut quiet = 0;
        let mut axes = self.axes();
        while self.tick() < limit {
            let has_sent = self.advance(TICK, sink)?;
            let moved = std::mem::replace(&mut axes, self.axes());
            let is_busy =
                has_sent || moved != axes || !self.board.has_read_all() || !self.active().is_empty();
            quiet = if is_busy { 0 } else { quiet + 1 };
            if quiet >= QUIET {
                return Ok(End::AllEnded);
            }
        }
        Ok(End::Limit)
    }

    /// Where the axes are commanded to be.
    fn axes(&self) -> Vec<Option<u64>> {
        AxisId::all().map(|axis| self.board.axis(axis).map(|(dest, _)| dest.to_bits())).collect()
    }

    /// Lets this many cycles pass; whether the firmware has sent lines.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(crate) fn advance(&mut self, cycles: u64, sink: &mut dyn FnMut(Event)) -> Result<bool, Halted> {
        let result = self.board.run_to(self.board.cycle() + cycles);
        let lines = self.board.take_lines();
        let has_sent = !lines.is_empty();
        for line in lines {
            sink(self.event(line));
        }
        result.map(|()| has_sent)
    }

    fn event(&self, line: Line) -> Event {
        let at = self.since_ready(line.cycle);
        let kind = match line.kind {
            Sent::Console => EventKind::ConsoleLine(line.text),
            Sent::Reply => EventKind::Reply(line.text),
            Sent::Request => {
                let text = String::from_utf8_lossy(line.text.get(1..).unwrap_or_default()).into_owned();
                EventKind::Host(format!(
                    "the program asks for the file `{text}`; files are not served with `--boot` yet"
                ))
            }
        };
        Event { at, kind }
    }

    /// Sends a line to the firmware, and lets pass the time until it has nothing more to say about it.
    ///
    /// # Errors
    /// The firmware ran away.
    pub(crate) fn exchange(&mut self, line: &str, sink: &mut dyn FnMut(Event)) -> Result<(), Halted> {
        self.board.send_line(line.as_bytes());
        let end = self.board.cycle() + ANSWER;
        let mut quiet = 0;
        while quiet < QUIET && self.board.cycle() < end {
            let has_sent = self.advance(TICK, sink)?;
            quiet = if has_sent || !self.board.has_read_all() { 0 } else { quiet + 1 };
        }
        Ok(())
    }
}
