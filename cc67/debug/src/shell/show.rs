//! Inspection: values, memory, calls, threads, source.

use std::fmt::Write as _;

use cc67_host::{Capability, Target};
use compiler::debug::NumberFormat;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{Cycles, ThreadId};
use vm::engine::ContextId;
use vm::thread::{Progress, ThreadState};

use super::history::{KeptValue, extension};
use super::{Assignment, Shell, context};
use crate::debugger::{
    CodePlace, DebugError, Debugger, Reason, ShownVariable, StackFrame, Stop, TypeDetail, file_name,
};
use crate::words::LineReader;

/// The maximum number of registers per line.
const COLUMNS: usize = 8;
/// The message that there are no locals.
const NO_LOCALS: &str = "where locals are in code for the processor is not noted; `info registers` shows the \
                         registers, and variables outside functions have names";

impl<T: Target> Shell<T> {
    pub(super) fn values(&mut self, name: &str, rest: &str) -> Result<String, DebugError> {
        let (format, rest) = format_of(rest);
        match name {
            "print" => self.print(format, rest),
            "output" => {
                let letter = format_of_letter(format)?;
                Ok(self.value_of(rest, letter)?.text)
            }
            "call" => {
                let text = self.print(format, rest)?;
                if !text.ends_with(" = void\n") {
                    return Ok(text);
                }
                self.history.drop_last();
                Ok(String::new())
            }
            "echo" => Ok(rest.replace("\\n", "\n").replace("\\t", "\t").replace("\\\"", "\"")),
            "ptype" | "whatis" => {
                let detail = if name == "ptype" { TypeDetail::Members } else { TypeDetail::Name };
                let replaced = self.replaced(rest)?;
                Ok(format!("type = {}\n", self.debugger.type_of(&replaced, detail)?))
            }
            "x" => self.memory(format, rest),
            _ => self.set(rest),
        }
    }

    /// An expression with `$1` and the like replaced by values, and `PLACE@COUNT` in C notation.
    pub(super) fn replaced(&mut self, expression: &str) -> Result<String, DebugError> {
        let frames = self.debugger.frames(self.debugger.context());
        let pc = frames.get(self.debugger.frame()).map(|frame| frame.address.get());
        let replaced = self.history.replaced(expression, pc)?;
        // The type of a character constant is `int` in C, and `char` in gdb.
        let is_character = replaced.len() > 2
            && replaced.starts_with('\'')
            && replaced[1..].find('\'') == Some(replaced.len() - 2);
        if is_character {
            return Ok(format!("((char){replaced})"));
        }
        let Some((place, count)) = extension(&replaced) else { return Ok(replaced) };
        let count = self.debugger.number_with_calls(count)?;
        self.debugger.extended(place, count)
    }

    /// The numeric value of an expression.
    pub(super) fn number_of(&mut self, expression: &str) -> Result<f64, DebugError> {
        let replaced = self.replaced(expression)?;
        self.debugger.number(&replaced)
    }

    /// The value of an expression, of `$1` and the like, or of an assignment, which is executed.
    fn value_of(&mut self, expression: &str, format: Option<NumberFormat>) -> Result<KeptValue, DebugError> {
        if let Some(Assignment { place, value, is_postfix }) = Assignment::of(expression) {
            let old = self.value_of(&place, format);
            self.assign(&place, &value)?;
            return if is_postfix { old } else { self.value_of(&place, format) };
        }
        if format.is_none()
            && let Some(kept) = self.history.value_by_name(expression)?
        {
            return Ok(kept);
        }
        let replaced = self.replaced(expression)?;
        let shown = self.debugger.evaluate_with_calls(&replaced, format)?;
        let cast = if format.is_none() { shown.cast } else { String::new() };
        Ok(KeptValue::of(&ShownVariable { cast, ..shown }))
    }

    fn print(&mut self, format: &str, expression: &str) -> Result<String, DebugError> {
        let letter = format_of_letter(format)?;
        let expression = if expression.is_empty() { "$" } else { expression };
        let value = self.value_of(expression, letter)?;
        let text = value.text.clone();
        Ok(format!("${} = {text}\n", self.history.keep(value)))
    }

    /// Assigns a value to a place of the program or a convenience variable.
    fn assign(&mut self, place: &str, value: &str) -> Result<(), DebugError> {
        if let Some(name) = place.strip_prefix('$') {
            let value = self.value_of(value, None)?;
            self.history.set(name, value);
            return Ok(());
        }
        let (place, value) = (self.replaced(place)?, self.replaced(value)?);
        self.debugger.set(&place, &value).map(|_| ())
    }

    fn set(&mut self, rest: &str) -> Result<String, DebugError> {
        let rest = rest.strip_prefix("variable ").or_else(|| rest.strip_prefix("var ")).unwrap_or(rest);
        let Assignment { place, value, .. } = Assignment::of(rest).ok_or("set var NAME = EXPRESSION")?;
        self.assign(&place, &value)?;
        Ok(String::new())
    }

    pub(super) fn look(&mut self, name: &str, rest: &str) -> Result<String, DebugError> {
        match name {
            "info" => self.info(rest),
            "backtrace" => self.backtrace(rest),
            "frame" | "up" | "down" => self.select_frame(name, rest),
            "thread" => {
                if !rest.is_empty() {
                    let thread = rest.parse().ok().and_then(ThreadId::new);
                    let thread = thread.ok_or_else(|| format!("Invalid thread ID: {rest}"))?;
                    self.debugger.select(thread, 0)?;
                    self.list_around_present();
                }
                let text = frame_line(&self.debugger, 0);
                Ok(format!("[Current thread is {}]\n{text}", self.debugger.thread()))
            }
            "list" => self.list(rest),
            "disassemble" => {
                let at =
                    self.debugger.frames(self.debugger.context()).first().map(|frame| frame.address.get());
                let at = at.ok_or("No frame selected.")?;
                let found = self.debugger.programs().at(at).ok_or("No function contains it.")?;
                let range = found.2.addresses.clone();
                Ok(self.instructions(range.start, u32::MAX, range.end))
            }
            _ => Ok(LineReader::help()),
        }
    }

    /// `backtrace [COUNT]`: all calls, the innermost COUNT, or the outermost with a negative number.
    fn backtrace(&mut self, rest: &str) -> Result<String, DebugError> {
        let count = self.debugger.frames(self.debugger.context()).len();
        if count == 0 {
            return Ok("No stack.\n".to_owned());
        }
        let wanted = if rest.is_empty() { count as i64 } else { self.number_of(rest)? as i64 };
        let chosen = usize::try_from(wanted.unsigned_abs()).unwrap_or(count).min(count);
        let range = if wanted < 0 { count - chosen..count } else { 0..chosen };
        let is_cut = range.end < count;
        let mut text: String = range.map(|index| frame_text(&self.debugger, index)).collect();
        if is_cut {
            text += "(More stack frames follow...)\n";
        }
        Ok(text)
    }

    /// `frame [N]`, `up [N]`, `down [N]`.
    fn select_frame(&mut self, name: &str, rest: &str) -> Result<String, DebugError> {
        let (frame, count) = (self.debugger.frame(), self.debugger.frames(self.debugger.context()).len());
        if count == 0 {
            return Err("No stack.".into());
        }
        let number = if rest.is_empty() { None } else { Some(self.number_of(rest)? as usize) };
        let wanted = match name {
            "up" if frame + 1 == count => return Err("Initial frame selected; you cannot go up.".into()),
            "up" => (frame + number.unwrap_or(1)).min(count - 1),
            "down" if frame == 0 => {
                return Err("Bottom (innermost) frame selected; you cannot go down.".into());
            }
            "down" => frame.saturating_sub(number.unwrap_or(1)),
            _ => number.unwrap_or(frame),
        };
        if wanted >= count {
            return Err(format!("No frame at level {rest}.").into());
        }
        self.debugger.select(self.debugger.thread(), wanted)?;
        self.list_around_present();
        Ok(frame_line(&self.debugger, wanted))
    }

    fn info(&mut self, what: &str) -> Result<String, DebugError> {
        let variables = |all: Vec<crate::debugger::ShownVariable>, none: &str| {
            let text: String = all.iter().map(|one| format!("{} = {}\n", one.name, one.text)).collect();
            if text.is_empty() { format!("{none}\n") } else { text }
        };
        if let Some(place) = what.strip_prefix("line") {
            return self.line_information(place.trim());
        }
        let is = |name: &str| !what.is_empty() && name.starts_with(what);
        Ok(match what {
            _ if is("threads") => threads(&self.debugger),
            _ if is("breakpoints") => self.table(false),
            _ if is("watchpoints") => self.table(true),
            _ if is("args") => {
                let debugger = &self.debugger;
                let frame = debugger.frames(debugger.context()).into_iter().nth(debugger.frame());
                let all = frame.map_or(Vec::new(), |frame| debugger.arguments(&frame));
                let text: String = all.iter().map(|one| one.replacen('=', " = ", 1) + "\n").collect();
                if text.is_empty() { "No arguments.\n".to_owned() } else { text }
            }
            _ if is("display") => self.displayed(),
            _ if is("locals") => {
                let is_real = self.debugger.session().can(Capability::ProcessorCode);
                let none = if is_real { NO_LOCALS } else { "No locals." };
                variables(self.debugger.own_locals(), none)
            }
            _ if is("registers") => registers(&self.debugger)?,
            _ if is("variables") => variables(self.debugger.globals(), "No variables."),
            _ if is("frame") => frame_line(&self.debugger, self.debugger.frame()),
            _ if is("history") => {
                let (bytes, snapshots) = self.debugger.history();
                let seconds = seconds(self.debugger.now());
                format!(
                    "{snapshots} snapshots, {} KiB of memory in them; the present is {seconds:.6} s\n",
                    bytes / 1024
                )
            }
            _ => return Err(format!("Undefined info command: \"{what}\".  Try \"help info\".").into()),
        })
    }
}

/// Board time in seconds.
pub(crate) fn seconds(at: Cycles) -> f64 {
    at.get() as f64 / Cycles::PER_SECOND.get() as f64
}

/// The format of `print/x EXPRESSION`, and the expression.
pub(super) fn format_of(rest: &str) -> (&str, &str) {
    let (format, rest) = match rest.strip_prefix('/') {
        Some(more) => more.split_once(char::is_whitespace).unwrap_or((more, "")),
        None => ("", rest),
    };
    (format, rest.trim())
}

/// The number format for the letters after a slash; `None` without a letter.
///
/// # Errors
/// There is no such form.
pub(crate) fn format_of_letter(letters: &str) -> Result<Option<NumberFormat>, DebugError> {
    let mut meant = letters.chars().filter(|letter| !letter.is_ascii_digit() && !"bhwg".contains(*letter));
    let Some(letter) = meant.next() else { return Ok(None) };
    let format = NumberFormat::from_letter(letter);
    format.map(Some).ok_or_else(|| format!("Undefined output format \"{letter}\".").into())
}

/// Describes the reason and the position of a stop.
pub(super) fn stop<T: Target>(debugger: &Debugger<T>, stop: &Stop) -> String {
    let at = format!("{:.6} s", seconds(stop.at));
    let who = match stop.context.map(ContextId::thread) {
        Some(Some(thread)) => format!("thread {thread}, {at}"),
        Some(None) => format!("call-back, {at}"),
        None => at,
    };
    let place = debugger.present();
    let head = match &stop.reason {
        Reason::Breakpoint(ids) => {
            let ids = ids.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
            let kind = if stop.is_temporary { "Temporary breakpoint" } else { "Breakpoint" };
            format!("\n{kind} {ids}, ")
        }
        Reason::Changed { id, expression, old, new, by } => {
            format!(
                "\nHardware watchpoint {id}: {expression}\n\nOld value = {old}\nNew value = {new}\nWritten by {by}\n"
            )
        }
        Reason::Accessed { id, expression, access, old, value, by } => {
            let values = match old {
                Some(old) => format!("Old value = {old}\nNew value = {value}"),
                None => format!("Value = {value}"),
            };
            format!("\n{} {id}: {expression}\n\n{values}\nAccessed by {by}\n", access.title())
        }
        Reason::Trap(text) => format!("Trap: {text}\n"),
        Reason::Remark(text) => format!("Remark: {text}\n"),
        Reason::Started(thread) => format!("Thread {thread} begins.\n"),
        Reason::Ended(thread) => format!("Thread {thread} has ended.\n"),
        Reason::Console(text) => format!("Console: {text}\n"),
        Reason::Bit(text) => format!("Catchpoint: {text}\n"),
        Reason::When { id, expression } => format!("\nCatchpoint {id} (when {expression})\n"),
        Reason::AllEnded => {
            return format!("[All threads have ended, {at}]\n", at = who.rsplit(", ").next().unwrap_or(""));
        }
        Reason::Interrupted => "Interrupted\n".to_owned(),
        Reason::LinkLost(why) => format!("{why}\n"),
        Reason::BeginOfHistory => "No more reverse-execution history.\n".to_owned(),
        Reason::Begin | Reason::Step | Reason::Time => String::new(),
    };
    let Some(place) = place.filter(|_| stop.context.is_some()) else { return format!("{head}[{who}]\n") };
    let frames = debugger.frames(debugger.context());
    let where_ =
        frames.get(debugger.frame()).map_or_else(String::new, |frame| located(debugger, frame, &place));
    format!("{head}{where_} [{who}]\n{}", source_line(debugger, &place))
}

fn source_line<T: Target>(debugger: &Debugger<T>, place: &CodePlace) -> String {
    let text = debugger.programs().of(place.thread).ok().filter(|model| {
        model.path.file_name().and_then(|name| name.to_str()) == Some(file_name(&place.file))
    });
    let text = text.map(|model| String::from_utf8_lossy(model.text()).into_owned());
    let line = text.as_deref().and_then(|text| text.lines().nth(place.line as usize - 1));
    line.map_or_else(String::new, |line| format!("{}\t{line}\n", place.line))
}

pub(super) fn frame_text<T: Target>(debugger: &Debugger<T>, index: usize) -> String {
    let frames = debugger.frames(debugger.context());
    let Some(frame) = frames.get(index) else { return "No stack.\n".to_owned() };
    match &frame.place {
        Some(place) => format!("#{index:<2} {}\n", located(debugger, frame, place)),
        None => format!("#{index}  {}\n", name_of(debugger, frame)),
    }
}

/// A call as gdb writes it: `square (n=3) at a.c:5`; with its address if that is in the middle of a line.
fn located<T: Target>(debugger: &Debugger<T>, frame: &StackFrame, place: &CodePlace) -> String {
    let address = if frame.real == 0 { frame.address } else { frame.view.continues_at };
    let is_at_line =
        frame.real == 0 && debugger.is_statement(address.get()) || place.is_inlined || frame.level > 0;
    let before = if is_at_line { String::new() } else { format!("{:#010x} in ", address.get()) };
    let arguments = debugger.arguments(frame).join(", ");
    format!("{before}{} ({arguments}) at {}:{}", place.function, file_name(&place.file), place.line)
}

fn frame_line<T: Target>(debugger: &Debugger<T>, index: usize) -> String {
    let place = debugger.frames(debugger.context()).into_iter().nth(index).and_then(|frame| frame.place);
    let source = place.map_or_else(String::new, |place| source_line(debugger, &place));
    frame_text(debugger, index) + &source
}

/// The name of code outside programs: a firmware function, or its address.
fn name_of<T: Target>(debugger: &Debugger<T>, frame: &StackFrame) -> String {
    if let Some(name) = debugger.session().target().firmware_function(frame.address) {
        return format!("{name} () of the firmware");
    }
    let mut models = debugger.programs().all().map(|(_, model)| model);
    let name = models.find_map(|model| model.image_function(frame.address.get()));
    name.map_or_else(|| frame.address.to_string(), |name| format!("{name} () of the library"))
}

/// The registers of the processor.
fn registers<T: Target>(debugger: &Debugger<T>) -> Result<String, DebugError> {
    let registers = debugger.session().target().registers();
    if registers.is_empty() {
        return Err("bytecode has no registers of the processor; `info locals` shows variables".into());
    }
    let rows = registers.chunks(COLUMNS).map(|row| {
        let cells: Vec<_> = row.iter().map(|(name, value)| format!("{name}={value:08X}")).collect();
        cells.join(" ") + "\n"
    });
    Ok(rows.collect())
}

/// Describes the state of a thread.
pub(crate) fn state<T: Target>(debugger: &Debugger<T>, thread: ThreadId) -> Option<String> {
    Some(match debugger.session().thread(thread) {
        ThreadState::Empty => return None,
        ThreadState::Ready => "not active".to_owned(),
        ThreadState::Active(Progress::Waiting(_)) => "waiting".to_owned(),
        ThreadState::Active(_) => "running".to_owned(),
        ThreadState::Paused(_) => "paused".to_owned(),
        ThreadState::Faulted(trap) => format!("stopped: {}", trap.kind),
    })
}

fn threads<T: Target>(debugger: &Debugger<T>) -> String {
    let mut out = String::from("  Id   State       Frame\n");
    let endings = debugger.session().ending().threads;
    for thread in ThreadId::all() {
        let Some(state) = state(debugger, thread) else { continue };
        let waits = endings.iter().find(|ending| ending.thread == thread && ending.state == "waiting");
        let waits =
            waits.map_or(String::new(), |ending| format!(", waits for {}", ending.waits_for.join(", ")));
        let mark = if thread == debugger.thread() { '*' } else { ' ' };
        let frames = debugger.frames(context(thread));
        // A firmware function, then the position in the program that called it.
        let shown = frames.iter().position(|frame| frame.place.is_some()).map_or(1, |index| index + 1);
        let shown: Vec<_> = frames
            .iter()
            .take(shown)
            .map(|frame| match &frame.place {
                Some(place) => {
                    format!("{} () at {}:{}", place.function, file_name(&place.file), place.line)
                }
                None => name_of(debugger, frame),
            })
            .collect();
        let frame = shown.join(" from ") + &waits;
        let _ = writeln!(out, "{mark} {:<4} {state:<11} {frame}", thread.to_string());
    }
    let _ = writeln!(
        out,
        "  tick {}, {:.6} s",
        debugger.session().tick().get(),
        debugger.session().tick().get() as f64 * TIMEBASE
    );
    out
}
