//! The command language of gdb, as text in and text out.

mod assignment;
mod breakpoints;
mod displays;
mod history;
mod listing;
mod memory;
mod show;

pub(crate) use assignment::Assignment;
pub(crate) use show::{format_of_letter, seconds, state};

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use cc67_host::{Capability, Target, remark};
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Event, EventKind};
use vm::engine::ContextId;

use crate::debugger::{DebugError, Debugger, Reason, StackFrame, Stop, WatchedAccess};
use crate::early::EarlyLines;
use crate::words::{BreakArguments, LineReader, is_move, split_if};
use history::{KeptValue, ShownValues};
use listing::ListedLines;
use memory::MemoryForm;

/// The result of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommandOutput {
    /// A text to show; it may be empty.
    Text(String),
    /// The user has quit.
    Quit,
}

/// A debugger with commands.
#[derive(Debug)]
pub struct Shell<T: Target = Board> {
    debugger: Debugger<T>,
    lines: LineReader,
    listing: ListedLines,
    history: ShownValues,
    /// The form in which `x` last showed memory.
    memory_form: MemoryForm,
    /// Expressions that are shown at every stop: number, format, expression.
    displays: Vec<(u32, String, String)>,
    last_display: u32,
    /// The commands that are executed when a breakpoint stops, by its number.
    commands: BTreeMap<u32, Vec<String>>,
    /// The breakpoint for which commands are being read.
    reading: Option<u32>,
    /// Lines that were shown before the board sent them.
    early: EarlyLines,
}

/// The receiver of output while the board runs: console lines, and descriptions of events.
pub type Output<'a> = &'a mut dyn FnMut(&str);

impl<T: Target> Shell<T> {
    /// Commands for a debugger.
    #[must_use]
    pub fn new(debugger: Debugger<T>) -> Self {
        Self {
            debugger,
            lines: LineReader::default(),
            listing: ListedLines::default(),
            history: ShownValues::default(),
            memory_form: MemoryForm::default(),
            displays: Vec::new(),
            last_display: 0,
            commands: BTreeMap::new(),
            reading: None,
            early: EarlyLines::default(),
        }
    }

    /// The debugger.
    #[must_use]
    pub const fn debugger(&self) -> &Debugger<T> {
        &self.debugger
    }

    /// Sets a flag that ends a run when it becomes true.
    pub fn interrupted_by(&mut self, flag: Arc<AtomicBool>) {
        self.debugger.interrupted_by(flag);
    }

    /// The debugger, for changes.
    pub(crate) const fn debugger_mut(&mut self) -> &mut Debugger<T> {
        &mut self.debugger
    }

    /// The completions of the text at the end of a line: commands, then names in the programs.
    #[must_use]
    pub fn complete(&self, line: &str) -> Vec<String> {
        let word =
            line.rsplit(|c: char| !(c.is_ascii_alphanumeric() || "_-".contains(c))).next().unwrap_or("");
        let mut names: Vec<String> = Vec::new();
        if line.trim_start() == word {
            names.extend(LineReader::names().map(str::to_owned));
        } else {
            for (_, model) in self.debugger.programs().all() {
                names.extend(model.functions.iter().map(|function| function.name.clone()));
                names.extend(model.globals().into_iter().map(|(name, ..)| name));
            }
            names.extend(self.debugger.locals().into_iter().map(|local| local.name));
        }
        names.retain(|name| name.starts_with(word));
        names.sort();
        names.dedup();
        names
    }

    /// Executes a line; an empty one repeats the last.
    ///
    /// # Errors
    /// The line is not valid.
    pub fn command(&mut self, line: &str, output: Output<'_>) -> Result<CommandOutput, DebugError> {
        if let Some(id) = self.reading {
            match line.trim() {
                "end" => self.reading = None,
                command => self.commands.entry(id).or_default().push(command.to_owned()),
            }
            return Ok(CommandOutput::Text(String::new()));
        }
        let mut said = self.one(line, output)?;
        // The commands of the breakpoint at which the board stopped; these may continue the run to another breakpoint.
        let mut next = if matches!(said, CommandOutput::Text(_)) {
            self.commands_of_stop(line)
        } else {
            VecDeque::new()
        };
        while let Some(command) = next.pop_front() {
            if let CommandOutput::Text(text) = &said {
                output(text);
            }
            said = self.one(&command, output)?;
            if self.is_move(&command) {
                next = self.commands_of_stop(&command);
            }
            if said == CommandOutput::Quit {
                break;
            }
        }
        Ok(said)
    }

    /// Returns whether time passes in a command.
    fn is_move(&self, line: &str) -> bool {
        self.lines.clone().read(line).ok().flatten().is_some_and(|(name, _)| is_move(name))
    }

    /// The commands of the breakpoints at which the movement of a line stopped.
    fn commands_of_stop(&self, line: &str) -> VecDeque<String> {
        if !self.is_move(line) {
            return VecDeque::new();
        }
        let ids = ids_of(&self.debugger.stop().reason);
        let commands = ids.iter().filter_map(|id| self.commands.get(id)).flatten();
        commands.filter(|command| *command != "silent").cloned().collect()
    }

    fn one(&mut self, line: &str, output: Output<'_>) -> Result<CommandOutput, DebugError> {
        let Some((name, rest)) = self.lines.read(line)? else {
            return Ok(CommandOutput::Text(String::new()));
        };
        if name == "quit" {
            return Ok(CommandOutput::Quit);
        }
        let text = self.execute(name, &rest, output)?;
        let mut messages = String::new();
        while let Some(message) = self.debugger.take_message() {
            messages += &message;
            messages.push('\n');
        }
        Ok(CommandOutput::Text(messages + &text))
    }

    fn execute(&mut self, name: &str, rest: &str, output: Output<'_>) -> Result<String, DebugError> {
        if !self.debugger.session().can(Capability::StopTime) {
            let Self { debugger, early, .. } = self;
            let mut teller = EventPrinter::new(debugger, early, output);
            debugger.catch_up(&mut |event| teller.report(event));
        }
        match name {
            _ if is_move(name) => self.move_on(name, rest, output),
            "kill" | "pause" | "resume" => self.control(name, rest),
            "commands" => self.read_commands(rest),
            "display" | "undisplay" => self.display(name, rest),
            "thread" if rest.starts_with("apply ") => self.apply(rest, output),
            "break" | "tbreak" => self.set_break(rest, name == "tbreak"),
            "watch" | "rwatch" | "awatch" => {
                let (expression, condition) = split_if(rest);
                let (_, text) = match name {
                    "rwatch" => self.debugger.watch_access(expression, WatchedAccess::Read, condition),
                    "awatch" => self.debugger.watch_access(expression, WatchedAccess::ReadWrite, condition),
                    _ => self.debugger.watch(expression, condition),
                }?;
                Ok(text + "\n")
            }
            "dprintf" => self.log_point(rest),
            "catch" => self.catch(rest),
            "condition" | "ignore" | "enable" | "disable" | "delete" => self.change(name, rest),
            "print" | "call" | "output" | "echo" | "ptype" | "whatis" | "x" | "set" => {
                let text = self.values(name, rest)?;
                // A function that was called may have printed.
                self.show_early(true, output);
                Ok(text)
            }
            "info" | "backtrace" | "frame" | "up" | "down" | "thread" | "list" | "disassemble" | "help" => {
                self.look(name, rest)
            }
            _ => Err(format!("Undefined command: \"{name}\".  Try \"help\".").into()),
        }
    }

    /// `commands [N]`: the next lines belong to a breakpoint; without a number, to the last one.
    fn read_commands(&mut self, rest: &str) -> Result<String, DebugError> {
        let last = self.debugger.breakpoints().last().map(|breakpoint| breakpoint.id);
        let id = match rest {
            "" => last.ok_or("No breakpoints specified.")?,
            number => number.parse().map_err(|_| format!("`{number}` is not the number of a breakpoint"))?,
        };
        if !self.debugger.breakpoints().iter().any(|breakpoint| breakpoint.id == id) {
            return Err(format!("No breakpoint number {id}.").into());
        }
        self.commands.insert(id, Vec::new());
        self.reading = Some(id);
        Ok(String::new())
    }

    /// `kill|pause|resume [N]`: controls one thread; without a number, the selected one.
    fn control(&mut self, name: &str, rest: &str) -> Result<String, DebugError> {
        let thread = if rest.is_empty() { self.debugger.thread() } else { thread_of(rest)? };
        match name {
            "kill" => self.debugger.stop_thread(thread),
            _ => self.debugger.pause(thread, name == "pause")?,
        }
        Ok(String::new())
    }

    /// `thread apply all|N… COMMAND`: executes a command with each of these threads, the highest number first as in
    /// gdb.
    fn apply(&mut self, rest: &str, output: Output<'_>) -> Result<String, DebugError> {
        let words: Vec<&str> = rest.split_whitespace().skip(1).collect();
        let is_number = |word: &&&str| **word == "all" || word.parse::<i32>().is_ok();
        let count = words.iter().take_while(is_number).count();
        let (chosen, command) = words.split_at(count);
        if chosen.is_empty() || command.is_empty() {
            return Err("thread apply all|N COMMAND".into());
        }
        let command = command.join(" ");
        if self.is_move(&command) {
            return Err(format!("`{command}` lets all threads go on").into());
        }
        let (thread, frame) = (self.debugger.thread(), self.debugger.frame());
        let is_meant = |one: &ThreadId| chosen.contains(&"all") || chosen.contains(&one.to_string().as_str());
        let mut threads: Vec<_> = ThreadId::all().filter(is_meant).collect();
        threads.reverse();
        let mut text = String::new();
        for one in threads {
            if state(&self.debugger, one).is_none() {
                continue;
            }
            self.debugger.select(one, 0)?;
            text += &format!("\nThread {one}:\n");
            match self.one(&command, output) {
                Ok(CommandOutput::Text(said)) => text += &said,
                Ok(CommandOutput::Quit) => {}
                Err(error) => text += &format!("{error}\n"),
            }
        }
        self.debugger.select(thread, frame)?;
        Ok(text)
    }

    /// Executes commands that let time pass, or go back in time.
    fn move_on(&mut self, name: &str, rest: &str, output: Output<'_>) -> Result<String, DebugError> {
        if matches!(name, "advance" | "goto") && rest.is_empty() {
            return Err(format!("{name} needs an argument.").into());
        }
        if name == "goto" {
            return self.go_to(rest, output);
        }
        let (count, place) = match name {
            "until" | "advance" | "run" => (1.0, rest),
            _ if rest.is_empty() => (1.0, rest),
            _ => (self.number_of(rest)?, ""),
        };
        let mut text = String::new();
        self.announce(name, count, output);
        let times = if name == "continue" || name == "run" { 1 } else { (count as u64).max(1) };
        if name == "continue" && count > 1.0 {
            self.ignore_present(count as u64 - 1, output);
        }
        let left = self.debugger.frames(self.debugger.context()).get(self.debugger.frame()).cloned();
        for _ in 0..times {
            let stop = self.once(name, place, output)?;
            text = self.stop_text(&stop);
            if name == "finish" && stop.reason == Reason::Step {
                text += &self.returned(left.as_ref());
            }
            if !matches!(stop.reason, Reason::Step | Reason::Time) {
                break;
            }
        }
        Ok(text)
    }

    /// Announces a movement, as gdb does.
    fn announce(&self, name: &str, count: f64, output: Output<'_>) {
        let frame = || show::frame_text(&self.debugger, self.debugger.frame());
        match name {
            "continue" if count <= 1.0 => output("Continuing.\n"),
            _ if name.starts_with("reverse") && !self.debugger.session().can(Capability::Snapshots) => {}
            "reverse-continue" => output("Continuing.\n"),
            "finish" | "reverse-finish" if !self.has_caller() => {}
            "finish" => output(&format!("Run till exit from {}", frame())),
            "reverse-finish" => output(&format!("Run back to call of {}", frame())),
            _ => {}
        }
    }

    fn has_caller(&self) -> bool {
        self.debugger.frames(self.debugger.context()).len() > self.debugger.frame() + 1
    }

    /// The result of the function that has returned, as `finish` shows it.
    fn returned(&mut self, left: Option<&StackFrame>) -> String {
        let place = left.and_then(|frame| frame.place.clone()).filter(|place| !place.is_inlined);
        let context = self.debugger.context();
        let result = place.and_then(|place| self.debugger.result_of(&place, context));
        result.map_or_else(String::new, |result| {
            let value = KeptValue::of(&result);
            let text = value.text.clone();
            format!("Value returned is ${} = {text}\n", self.history.keep(value))
        })
    }

    /// Executes one movement and shows the output of programs until then, even if the board has not sent it yet.
    fn once(&mut self, name: &str, place: &str, output: Output<'_>) -> Result<Stop, DebugError> {
        let Self { debugger, early, .. } = self;
        let mut teller = EventPrinter::new(debugger, early, output);
        let stop = move_forward(debugger, name, place, &mut |event| teller.report(event));
        let scene = std::mem::take(&mut teller.scene);
        self.show_early(!name.starts_with("reverse"), output);
        output(&scene);
        stop
    }

    /// Shows the lines that the board has not sent yet; after going back in time they have already been shown.
    fn show_early(&mut self, is_forward: bool, output: Output<'_>) {
        let unsent = self.debugger.session().target().unsent_lines();
        if !is_forward {
            self.early.go_back(unsent);
            return;
        }
        for line in self.early.show(unsent) {
            output(&format!("{}\n", String::from_utf8_lossy(&line)));
        }
    }

    /// `continue COUNT` passes the present breakpoint COUNT - 1 times.
    fn ignore_present(&mut self, times: u64, output: Output<'_>) {
        for id in ids_of(&self.debugger.stop().reason) {
            if let Some(breakpoint) = self.debugger.breakpoint_mut(id) {
                breakpoint.ignore = times;
                output(&format!("Will ignore next {times} crossings of breakpoint {id}.  Continuing.\n"));
            }
        }
    }

    fn go_to(&mut self, rest: &str, output: Output<'_>) -> Result<String, DebugError> {
        let seconds: f64 = rest
            .trim_end_matches('s')
            .trim()
            .parse()
            .map_err(|_| format!("`{rest}` is not a time in seconds"))?;
        // The last tick completed at that time.
        let tick = Ticks::new(((seconds / TIMEBASE + 1e-6).floor() - 1.0).max(0.0) as u64);
        let Self { debugger, early, .. } = self;
        let is_forward = tick > debugger.session().tick();
        let stop = if is_forward {
            let mut teller = EventPrinter::new(debugger, early, output);
            let stop = debugger.run_to(tick, &mut |event| teller.report(event));
            let scene = std::mem::take(&mut teller.scene);
            output(&scene);
            stop
        } else {
            debugger.go_to(tick)?
        };
        self.show_early(is_forward, output);
        Ok(self.stop_text(&stop))
    }

    fn set_break(&mut self, rest: &str, is_temporary: bool) -> Result<String, DebugError> {
        let BreakArguments { place, thread, condition } = BreakArguments::of(rest);
        let own = self.debugger.present().map(|place| place.line.to_string());
        let place = if place.is_empty() {
            own.ok_or("No default breakpoint location now.")?
        } else {
            place.to_owned()
        };
        let (id, text) = self.debugger.break_at(&place, thread, condition)?;
        if let Some(breakpoint) = self.debugger.breakpoint_mut(id) {
            breakpoint.is_temporary = is_temporary;
        }
        let text = if is_temporary { text.replacen("Breakpoint", "Temporary breakpoint", 1) } else { text };
        Ok(text + "\n")
    }

    fn log_point(&mut self, rest: &str) -> Result<String, DebugError> {
        let (place, text) = rest.split_once(',').ok_or("dprintf PLACE,TEXT")?;
        let (id, said) = self.debugger.break_at(place, None, None)?;
        if let Some(breakpoint) = self.debugger.breakpoint_mut(id) {
            breakpoint.log = Some(text.trim().trim_matches('"').to_owned());
        }
        Ok(said.replacen("Breakpoint", "Dprintf", 1) + "\n")
    }

    fn catch(&mut self, rest: &str) -> Result<String, DebugError> {
        let (what, argument) = rest.split_once(' ').unwrap_or((rest, ""));
        let catches = &mut self.debugger.catches;
        match what {
            "trap" => catches.no_traps = false,
            "no-trap" => catches.no_traps = true,
            "remark" => catches.remarks = true,
            "start" => catches.starts = true,
            "end" => catches.ends = true,
            "console" if !argument.is_empty() => catches.texts.push(argument.trim_matches('"').to_owned()),
            "bit" => {
                let number = argument.trim().parse().map_err(|_| "catch bit NUMBER")?;
                catches.bits.push(number);
            }
            "when" if !argument.trim().is_empty() => {
                let (_, text) = self.debugger.catch_when(argument.trim().trim_matches('"'))?;
                return Ok(text + "\n");
            }
            _ => return Err("catch trap|no-trap|remark|start|end|console TEXT|bit N|when EXPRESSION".into()),
        }
        Ok(format!("Catchpoint: {rest}\n"))
    }

    fn change(&mut self, name: &str, rest: &str) -> Result<String, DebugError> {
        let (number, argument) = rest.split_once(' ').unwrap_or((rest, ""));
        let ids: Vec<u32> = match number {
            "" if matches!(name, "delete" | "enable" | "disable") => {
                self.debugger.breakpoints().iter().map(|breakpoint| breakpoint.id).collect()
            }
            _ => vec![number.parse().map_err(|_| format!("`{number}` is not the number of a breakpoint"))?],
        };
        let mut text = String::new();
        for id in ids {
            let missing = || DebugError::from(format!("No breakpoint number {id}."));
            match name {
                "delete" => self.debugger.delete(id).then_some(()).ok_or_else(missing)?,
                "condition" => {
                    let condition = Some(argument.trim()).filter(|text| !text.is_empty());
                    self.debugger.set_condition(id, condition)?;
                    if condition.is_none() {
                        text += &format!("Breakpoint {id} now unconditional.\n");
                    }
                }
                "ignore" => {
                    let count: u64 = argument.trim().parse().map_err(|_| "ignore N COUNT")?;
                    self.debugger.breakpoint_mut(id).ok_or_else(missing)?.ignore = count;
                    text += &match count {
                        0 => format!("Will stop next time breakpoint {id} is reached.\n"),
                        1 => format!("Will ignore next crossing of breakpoint {id}.\n"),
                        _ => format!("Will ignore next {count} crossings of breakpoint {id}.\n"),
                    };
                }
                _ => self.debugger.breakpoint_mut(id).ok_or_else(missing)?.is_enabled = name == "enable",
            }
        }
        Ok(text)
    }

    /// Describes the reason and the position of a stop, as gdb does.
    fn stop_text(&mut self, stop: &Stop) -> String {
        self.list_around_present();
        let silent =
            |id: &u32| self.commands.get(id).is_some_and(|lines| lines.iter().any(|line| line == "silent"));
        if ids_of(&stop.reason).iter().any(silent) {
            return String::new();
        }
        show::stop(&self.debugger, stop) + &self.shown_all()
    }
}

/// Executes a movement of the board.
fn move_forward<T: Target>(
    debugger: &mut Debugger<T>,
    name: &str,
    place: &str,
    events: &mut dyn FnMut(&Event),
) -> Result<Stop, DebugError> {
    Ok(match name {
        "run" if !place.is_empty() => {
            debugger.start(thread_of(place)?)?;
            debugger.go_on(events)
        }
        "run" => {
            let is_simulated = debugger.session().can(Capability::StopTime);
            if !is_simulated || debugger.stop().reason != Reason::Begin {
                debugger.start_again()?;
            }
            debugger.go_on(events)
        }
        "until" if place.is_empty() => debugger.until_later(events)?,
        "until" | "advance" => debugger.until(place, events)?,
        "step" => debugger.step(events)?,
        "next" => debugger.next(events)?,
        "finish" => debugger.finish(events)?,
        "stepi" => debugger.step_instruction(events)?,
        "tick" => debugger.step_tick(events),
        "slice" => debugger.step_slice(events)?,
        _ if name.starts_with("reverse") => {
            debugger.session().require(Capability::Snapshots)?;
            move_back(debugger, name)?
        }
        _ => debugger.go_on(events),
    })
}

/// Moves back in time by a command.
fn move_back<T: Target>(debugger: &mut Debugger<T>, name: &str) -> Result<Stop, DebugError> {
    Ok(match name {
        "reverse-continue" => debugger.reverse_continue(),
        "reverse-step" => debugger.reverse_step()?,
        "reverse-next" => debugger.reverse_next()?,
        "reverse-stepi" => debugger.reverse_step_instruction(),
        _ => debugger.reverse_finish()?,
    })
}

/// The thread with a number.
fn thread_of(number: &str) -> Result<ThreadId, DebugError> {
    let thread = number.parse().ok().and_then(ThreadId::new);
    Ok(thread.ok_or_else(|| format!("`{number}` is not the number of a thread"))?)
}

/// The breakpoints of a stop.
fn ids_of(reason: &Reason) -> Vec<u32> {
    match reason {
        Reason::Breakpoint(ids) => ids.clone(),
        Reason::Changed { id, .. } | Reason::Accessed { id, .. } | Reason::When { id, .. } => vec![*id],
        _ => Vec::new(),
    }
}

/// Writes events as lines.
struct EventPrinter<'a, 'b> {
    infos: Vec<runtime::debug::DebugInfo>,
    /// Lines that have already been shown.
    early: &'a mut EarlyLines,
    /// The report of a trap, which is shown after the output that preceded it.
    scene: String,
    output: &'a mut (dyn FnMut(&str) + 'b),
}

impl<'a, 'b> EventPrinter<'a, 'b> {
    fn new<T: Target>(
        debugger: &Debugger<T>,
        early: &'a mut EarlyLines,
        output: &'a mut (dyn FnMut(&str) + 'b),
    ) -> Self {
        let infos = debugger.session().debug().into_iter().map(|(_, info)| info).collect();
        Self { infos, early, scene: String::new(), output }
    }

    fn report(&mut self, event: &Event) {
        match &event.kind {
            EventKind::ConsoleLine(line) if self.early.take(line) => {}
            EventKind::ConsoleLine(line) => (self.output)(&format!("{}\n", String::from_utf8_lossy(line))),
            // Its text is the reason of the stop.
            EventKind::Trap(_) => {
                if let Some(scene) = remark::scene(event) {
                    self.scene += &scene.to_string();
                }
            }
            _ => {
                if let Some(text) = remark::describe(event, &self.infos) {
                    (self.output)(&format!("cc67: {text}\n"));
                }
            }
        }
    }
}

/// The context of a thread.
const fn context(thread: ThreadId) -> ContextId {
    ContextId::of(thread)
}
