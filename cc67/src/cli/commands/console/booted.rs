//! `cc67 console --boot FILE`: script commands to the user's own firmware file.
//!
//! By hand the board keeps pace with the clock; from a script board time passes as its lines need it, and as `wait` says.

use std::collections::BTreeMap;
use std::io::{self, IsTerminal};
use std::path::Path;
use std::sync::mpsc::RecvTimeoutError;

use anyhow::{Context, Result, bail};
use boot::Halted;
use cc67_host::End;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{Bit, Cycles, ThreadId, Ticks};

use super::input::{self, Input, Lines};
use super::screen::Screen;
use super::words::{self, Word};
use super::{BEAT, ConsoleArguments, Flow, STRETCH, Shown};
use crate::cli::args::attach::AttachArguments;
use crate::cli::args::program::{ProgramFile, assign};
use crate::cli::args::time::DEFAULT_LIMIT;
use crate::cli::commands::serve::own_firmware::{self, Asked};
use crate::cli::io::exit::Exit;
use crate::cli::io::pace::Pace;
use crate::cli::report::seen::Seen;
use crate::cli::report::trace::Trace;
use crate::cli::session::booted::{Begun, Booted};

/// Talks to the firmware until the input ends.
pub(super) fn console(arguments: &ConsoleArguments, file: &Path) -> Result<Exit> {
    if let Some(option) = arguments.board.left_out_by_boot() {
        bail!("`{option}` does not work with `--boot`");
    }
    if let Some(address) = &arguments.serve {
        AttachArguments { debug: arguments.debug }.open(&arguments.board)?;
        let asked =
            Asked { programs: &arguments.programs, board: &arguments.board, compiler: &arguments.compiler };
        return own_firmware::serve(&asked, file, &arguments.terms(address));
    }
    let mut booted = Booted::new(file)?;
    let programs = arguments.programs.as_slice();
    let begun = booted.begin(programs, &arguments.board, &arguments.compiler, Some(&arguments.trace))?;
    let Some(Begun { request }) = begun else { return Ok(Exit::Failure) };
    let trace = request.as_ref().map(|request| Trace::begin(&arguments.trace, request)).transpose()?;
    booted.connect()?;
    let shown = Shown { screen: Screen::new(arguments.time, false), seen: Seen::default(), trace, arguments };
    let mut console = Console { arguments, booted, shown, pressed: BTreeMap::new(), has_crashed: false };
    console.know_programs();
    if io::stdin().is_terminal() && io::stdout().is_terminal() {
        console.keyboard()
    } else if arguments.realtime {
        console.keep_pace(&input::script_beside())
    } else {
        console.script()
    }
}

/// The firmware, and the person or script that talks to it.
struct Console<'a> {
    arguments: &'a ConsoleArguments,
    booted: Booted,
    shown: Shown<'a>,
    /// Inputs that are pressed, and the level of each before.
    pressed: BTreeMap<Bit, bool>,
    has_crashed: bool,
}

impl Console<'_> {
    /// Has the screen know what is loaded.
    fn know_programs(&mut self) {
        self.shown.screen.programs = self.booted.debug().into_iter().map(|(_, debug)| debug).collect();
    }

    fn keyboard(&mut self) -> Result<Exit> {
        let (lines, printer) = input::keyboard()?;
        self.shown.screen.print_through(printer);
        if !self.arguments.fast {
            return self.keep_pace(&lines);
        }
        while let Ok(Input::Line(line)) = lines.next() {
            if self.line(&line) == Flow::Leave {
                break;
            }
            lines.ready();
        }
        self.leave()
    }

    /// Takes lines as they come while the board keeps pace with the clock.
    fn keep_pace(&mut self, lines: &Lines) -> Result<Exit> {
        let pace = Pace::new(self.booted.tick());
        loop {
            match lines.within(BEAT) {
                Ok(Input::Line(line)) if self.line(&line) == Flow::Continue => lines.ready(),
                Ok(_) | Err(RecvTimeoutError::Disconnected) => return self.leave(),
                Err(RecvTimeoutError::Timeout) if self.shown.screen.is_closed() => return self.leave(),
                Err(RecvTimeoutError::Timeout) => {}
            }
            // A firmware that falls behind leaves room for the keyboard.
            let end = pace.due().min(Ticks::new(self.booted.tick().get() + STRETCH));
            while self.booted.tick() < end && !self.has_crashed {
                self.advance(Cycles::PER_TICK);
            }
        }
    }

    /// Takes the lines of a script one after another; then the programs continue to their end.
    fn script(&mut self) -> Result<Exit> {
        for line in io::stdin().lines() {
            let line = line.context("cannot read the script")?;
            if self.line(&line) == Flow::Leave || self.shown.screen.is_closed() {
                return self.leave();
            }
        }
        let seconds = self.arguments.limit.unwrap_or(DEFAULT_LIMIT);
        let limit = Ticks::new(self.booted.tick().get() + (seconds / TIMEBASE) as u64);
        let shown = &mut self.shown;
        let end = self.booted.run(limit, None, &mut |event| shown.note(&event));
        if let Err(halted) = end {
            self.tell(&halted);
        }
        self.leave()
    }

    fn leave(&mut self) -> Result<Exit> {
        let shown = &mut self.shown;
        self.booted.finish(&mut |event| shown.note(&event))?;
        shown.finish(self.booted.tick())?;
        Ok(if self.has_crashed { Exit::Trapped } else { shown.seen.exit(End::AllEnded, true).0 })
    }

    fn line(&mut self, line: &str) -> Flow {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            return Flow::Continue;
        }
        let word = match words::parse(line) {
            Some(Ok(Word::Quit)) => return Flow::Leave,
            Some(Ok(word)) => word,
            Some(Err(error)) => {
                self.shown.screen.note(&error.to_string());
                return Flow::Continue;
            }
            None => {
                self.send(line);
                return Flow::Continue;
            }
        };
        if let Err(error) = self.obey(&word) {
            self.shown.screen.note(&format!("{error:#}"));
        }
        Flow::Continue
    }

    /// Does what one of the console's own words says.
    fn obey(&mut self, word: &Word) -> Result<()> {
        match word {
            Word::Help(name) => self.shown.screen.text(&words::help(name.as_deref())),
            Word::Kill { except } => {
                for thread in ThreadId::all().filter(|thread| Some(*thread) != *except) {
                    self.send(&format!("Kill{thread}"));
                }
            }
            Word::Load(file) | Word::Run(file) => {
                let starts = usize::from(matches!(word, Word::Run(_)));
                self.load(&assign(std::slice::from_ref(file))?, starts)?;
            }
            Word::Time => {
                let seconds = self.booted.now().get() as f64 / Cycles::PER_SECOND.get() as f64;
                self.shown.screen.text(&format!("{seconds:.6}\n"));
            }
            Word::Wait(seconds) => {
                self.advance(Cycles::new((seconds * Cycles::PER_SECOND.get() as f64) as i64));
            }
            Word::Press(bit) => {
                let level = self.booted.bit(*bit);
                self.pressed.entry(*bit).or_insert(level);
                self.booted.act(&format!("bit {bit} = {}", u8::from(!level)))?;
            }
            Word::Release(bit) => {
                let level = self.pressed.remove(bit).unwrap_or(false);
                self.booted.act(&format!("bit {bit} = {}", u8::from(level)))?;
            }
            Word::Act(statement) => self.booted.act(statement)?,
            Word::Quit => {}
        }
        Ok(())
    }

    /// Lets time pass.
    fn advance(&mut self, time: Cycles) {
        let shown = &mut self.shown;
        let passed = self.booted.advance(time.get().unsigned_abs(), &mut |event| shown.note(&event));
        if let Err(halted) = passed {
            self.tell(&halted);
        }
    }

    fn load(&mut self, files: &[ProgramFile], starts: usize) -> Result<bool> {
        let loaded = self.booted.load(files, starts, &self.arguments.compiler);
        self.know_programs();
        loaded
    }

    fn send(&mut self, line: &str) {
        let shown = &mut self.shown;
        let answered = self.booted.exchange(line, &mut |event| shown.note(&event));
        if let Err(halted) = answered {
            self.tell(&halted);
        }
    }

    /// The firmware ran away; the command line continues.
    fn tell(&mut self, halted: &Halted) {
        self.has_crashed = true;
        self.shown.screen.note(halted.to_string().trim_end());
    }
}
