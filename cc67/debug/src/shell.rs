//! The commands that people know from gdb, as text in and text out.

mod show;

pub(crate) use show::{seconds, state};

use cc67_host::{Target, remark};
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{ThreadId, Ticks};
use runtime::{Board, Event, EventKind};
use vm::engine::ContextId;

use crate::debugger::{BreakpointKind, DebugError, Debugger, Reason, Stop};
use crate::words::{BreakWords, LineReader, split_if};

/// What comes of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Said {
    /// A text to show; it may be empty.
    Text(String),
    /// The end.
    Quit,
}

/// A debugger with commands.
#[derive(Debug)]
pub struct Shell<T: Target = Board> {
    debugger: Debugger<T>,
    lines: LineReader,
    /// The line that `list` continues with.
    listed: u32,
    values: u32,
}

/// What receives what the board says while it runs: console lines, and words about events.
pub type Output<'a> = &'a mut dyn FnMut(&str);

impl<T: Target> Shell<T> {
    /// Commands for a debugger.
    #[must_use]
    pub fn new(debugger: Debugger<T>) -> Self {
        Self { debugger, lines: LineReader::default(), listed: 0, values: 0 }
    }

    /// The debugger.
    #[must_use]
    pub const fn debugger(&self) -> &Debugger<T> {
        &self.debugger
    }

    /// The names that the text at the end of a line may become: commands, then what programs name.
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

    /// Does what a line says; an empty one repeats the last.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn command(&mut self, line: &str, output: Output<'_>) -> Result<Said, DebugError> {
        let Some((name, rest)) = self.lines.read(line)? else { return Ok(Said::Text(String::new())) };
        if name == "quit" {
            return Ok(Said::Quit);
        }
        let text = self.execute(name, &rest, output)?;
        let mut messages = String::new();
        while let Some(message) = self.debugger.take_message() {
            messages += &message;
            messages.push('\n');
        }
        Ok(Said::Text(messages + &text))
    }

    fn execute(&mut self, name: &str, rest: &str, output: Output<'_>) -> Result<String, DebugError> {
        match name {
            "break" | "tbreak" => self.set_break(rest, name == "tbreak"),
            "watch" => {
                let (expression, condition) = split_if(rest);
                let (_, text) = self.debugger.watch(expression, condition)?;
                Ok(text + "\n")
            }
            "dprintf" => self.log_point(rest),
            "catch" => self.catch(rest),
            "condition" | "ignore" | "enable" | "disable" | "delete" => self.change(name, rest),
            "print" | "ptype" | "x" | "set" => self.values(name, rest),
            "info" | "backtrace" | "frame" | "up" | "down" | "thread" | "list" | "disassemble" | "help" => {
                self.look(name, rest)
            }
            _ => self.move_on(name, rest, output),
        }
    }

    /// Commands that let time pass, or go back in it.
    fn move_on(&mut self, name: &str, rest: &str, output: Output<'_>) -> Result<String, DebugError> {
        if matches!(name, "until" | "advance" | "goto") && rest.is_empty() {
            return Err(format!("{name} needs an argument.").into());
        }
        if name == "goto" {
            return self.go_to(rest, output);
        }
        if matches!(name, "until" | "advance") {
            let debugger = &mut self.debugger;
            let mut teller = Teller::new(debugger, output);
            let stop = debugger.until(rest, &mut |event| teller.tell(event))?;
            return Ok(self.stop_text(&stop));
        }
        let count = if rest.is_empty() { 1.0 } else { self.debugger.number(rest)? };
        let mut text = String::new();
        let times = if name == "continue" || name == "run" { 1 } else { (count as u64).max(1) };
        if name == "continue" && count > 1.0 {
            self.ignore_present(count as u64 - 1);
        }
        for _ in 0..times {
            let stop = self.once(name, output)?;
            text = self.stop_text(&stop);
            if !matches!(stop.reason, Reason::Step | Reason::Time) {
                break;
            }
        }
        Ok(text)
    }

    fn once(&mut self, name: &str, output: Output<'_>) -> Result<Stop, DebugError> {
        let debugger = &mut self.debugger;
        let mut teller = Teller::new(debugger, output);
        let events = &mut |event: &Event| teller.tell(event);
        Ok(match name {
            "run" => {
                if debugger.stop().reason != Reason::Begin {
                    debugger.restart()?;
                }
                debugger.go_on(events)
            }
            "step" => debugger.step(events)?,
            "next" => debugger.next(events)?,
            "finish" => debugger.finish(events)?,
            "stepi" => debugger.step_instruction(events)?,
            "tick" => debugger.step_tick(events),
            "slice" => debugger.step_slice(events),
            "reverse-continue" => debugger.reverse_continue(),
            "reverse-step" => debugger.reverse_step()?,
            "reverse-next" => debugger.reverse_next()?,
            "reverse-stepi" => debugger.reverse_step_instruction(),
            "reverse-finish" => debugger.reverse_finish()?,
            _ => debugger.go_on(events),
        })
    }

    /// `continue COUNT` passes the breakpoint where one stands COUNT - 1 times.
    fn ignore_present(&mut self, times: u64) {
        if let Reason::Breakpoint(ids) = self.debugger.stop().reason.clone() {
            for id in ids {
                if let Some(breakpoint) = self.debugger.breakpoint_mut(id) {
                    breakpoint.ignore = times;
                }
            }
        }
    }

    fn go_to(&mut self, rest: &str, output: Output<'_>) -> Result<String, DebugError> {
        let seconds: f64 = rest
            .trim_end_matches('s')
            .trim()
            .parse()
            .map_err(|_| format!("`{rest}` is not a time in seconds"))?;
        // The last tick that is over at that time.
        let tick = Ticks::new(((seconds / TIMEBASE + 1e-6).floor() - 1.0).max(0.0) as u64);
        let debugger = &mut self.debugger;
        let stop = if tick <= debugger.session().tick() {
            debugger.go_to(tick)?
        } else {
            let mut teller = Teller::new(debugger, output);
            debugger.run_to(tick, &mut |event| teller.tell(event))
        };
        Ok(self.stop_text(&stop))
    }

    fn set_break(&mut self, rest: &str, is_temporary: bool) -> Result<String, DebugError> {
        let BreakWords { place, thread, condition } = BreakWords::of(rest);
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
            _ => return Err("catch trap|no-trap|remark|start|end|console TEXT|bit N".into()),
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
        for id in ids {
            let missing = || DebugError::from(format!("No breakpoint number {id}."));
            match name {
                "delete" => self.debugger.delete(id).then_some(()).ok_or_else(missing)?,
                "condition" => {
                    self.debugger.set_condition(id, Some(argument.trim()).filter(|text| !text.is_empty()))?;
                }
                "ignore" => {
                    let count = argument.trim().parse().map_err(|_| "ignore N COUNT")?;
                    self.debugger.breakpoint_mut(id).ok_or_else(missing)?.ignore = count;
                }
                _ => self.debugger.breakpoint_mut(id).ok_or_else(missing)?.is_enabled = name == "enable",
            }
        }
        Ok(String::new())
    }

    /// Why the board stands, and where, as gdb says it.
    fn stop_text(&mut self, stop: &Stop) -> String {
        let place = self.debugger.present();
        self.listed = place.as_ref().map_or(self.listed, |place| place.line.saturating_sub(5));
        show::stop(&self.debugger, stop)
    }
}

/// Hands events over as lines.
struct Teller<'a, 'b> {
    infos: Vec<runtime::debug::DebugInfo>,
    output: &'a mut (dyn FnMut(&str) + 'b),
}

impl<'a, 'b> Teller<'a, 'b> {
    fn new<T: Target>(debugger: &Debugger<T>, output: &'a mut (dyn FnMut(&str) + 'b)) -> Self {
        let infos = debugger.session().debug().into_iter().map(|(_, info)| info).collect();
        Self { infos, output }
    }

    fn tell(&mut self, event: &Event) {
        match &event.kind {
            EventKind::ConsoleLine(line) => (self.output)(&format!("{}\n", String::from_utf8_lossy(line))),
            // Its text is the reason of the stop.
            EventKind::Trap(_) => {
                if let Some(scene) = remark::scene(event) {
                    (self.output)(&scene.to_string());
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

/// What the breakpoints are, a line each.
fn breakpoints<T: Target>(debugger: &Debugger<T>) -> String {
    let mut out = String::new();
    for breakpoint in debugger.breakpoints() {
        let kind = match &breakpoint.kind {
            BreakpointKind::Code(place, _) if breakpoint.log.is_some() => format!("dprintf     {place}"),
            BreakpointKind::Code(place, _) => format!("breakpoint  {place}"),
            BreakpointKind::Watch(expression) => format!("watchpoint  {expression}"),
        };
        let enabled = if breakpoint.is_enabled { 'y' } else { 'n' };
        out += &format!("{:<4} {enabled} {kind}\n", breakpoint.id);
        if let Some(condition) = &breakpoint.condition {
            out += &format!("\tstop only if {condition}\n");
        }
        if breakpoint.hits > 0 {
            let plural = if breakpoint.hits == 1 { "" } else { "s" };
            out += &format!("\tbreakpoint already hit {} time{plural}\n", breakpoint.hits);
        }
    }
    if out.is_empty() { "No breakpoints or watchpoints.\n".to_owned() } else { out }
}

/// The context of a thread.
const fn context(thread: ThreadId) -> ContextId {
    ContextId::of(thread)
}
