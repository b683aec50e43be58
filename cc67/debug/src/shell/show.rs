//! Looking: values, memory, calls, threads, source.

use std::fmt::Write as _;

use cc67_host::{Capability, Target};
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{Cycles, GuestAddr, ThreadId};
use vm::engine::ContextId;
use vm::thread::{Progress, ThreadState};

use super::{Assignment, Shell, breakpoints, context};
use crate::debugger::{CodePlace, DebugError, Debugger, Reason, StackFrame, Stop, file_name};
use crate::words::LineReader;

/// Lines that `list` shows.
const LINES: u32 = 10;
/// Most registers in a line.
const COLUMNS: usize = 8;
/// The message that there are none.
const NO_LOCALS: &str = "where locals are in code for the processor is not noted; `info registers` shows the \
                         registers, and variables outside of functions have names";

impl<T: Target> Shell<T> {
    pub(super) fn values(&mut self, name: &str, rest: &str) -> Result<String, DebugError> {
        let (format, rest) = format_of(rest);
        match name {
            "print" => self.print(format, rest),
            "call" => {
                let text = self.print(format, rest)?;
                if !text.ends_with(" = void\n") {
                    return Ok(text);
                }
                self.values -= 1;
                Ok(String::new())
            }
            "ptype" => Ok(format!("type = {}\n", self.debugger.evaluate(rest)?.ty)),
            "x" => self.memory(format, rest),
            _ => self.set(rest),
        }
    }

    fn print(&mut self, format: &str, expression: &str) -> Result<String, DebugError> {
        let assignment = Assignment::of(expression);
        let shown = assignment.as_ref().map_or(expression, |assignment| assignment.place.as_str());
        let text_of = |debugger: &mut Debugger<T>| match format {
            "" => Ok(debugger.evaluate_with_calls(shown)?.text),
            _ => number_as(debugger.number_with_calls(shown)?, format),
        };
        let text = match &assignment {
            Some(Assignment { place, value, is_postfix }) => {
                let old = text_of(&mut self.debugger);
                self.debugger.set(place, value)?;
                if *is_postfix { old? } else { text_of(&mut self.debugger)? }
            }
            None => text_of(&mut self.debugger)?,
        };
        self.values += 1;
        Ok(format!("${} = {text}\n", self.values))
    }

    fn set(&mut self, rest: &str) -> Result<String, DebugError> {
        let rest = rest.strip_prefix("variable ").or_else(|| rest.strip_prefix("var ")).unwrap_or(rest);
        let Assignment { place, value, .. } = Assignment::of(rest).ok_or("set var NAME = EXPRESSION")?;
        self.debugger.set(&place, &value)?;
        Ok(String::new())
    }

    fn memory(&self, format: &str, expression: &str) -> Result<String, DebugError> {
        let digits: String = format.chars().take_while(char::is_ascii_digit).collect();
        let count: u32 = digits.parse().unwrap_or(1).min(4096);
        let letters = format.get(digits.len()..).unwrap_or("");
        let kind = letters.chars().find(|c| "xduofsci".contains(*c)).unwrap_or('x');
        let size: u32 = match letters.chars().find(|c| "bhwg".contains(*c)) {
            Some('b') => 1,
            Some('h') => 2,
            Some('g') => 8,
            _ if kind == 'c' => 1,
            _ => 4,
        };
        let value = self.debugger.evaluate(expression)?;
        let address = match value.address.filter(|_| value.ty.ends_with(']')) {
            Some(address) => address,
            None => self.debugger.number(expression)? as i64 as u32,
        };
        if kind == 'i' {
            return Ok(self.instructions(address, count, u32::MAX));
        }
        let mut out = String::new();
        if kind == 's' {
            self.must_be_mapped(address)?;
            let bytes = self.debugger.bytes(address, 256);
            let text: Vec<u8> = bytes.into_iter().take_while(|byte| *byte != 0).collect();
            return Ok(format!("{address:#010x}: {:?}\n", String::from_utf8_lossy(&text)));
        }
        let row = 16 / size.max(4);
        for index in 0..count {
            let at = address.wrapping_add(index * size);
            if index % row == 0 {
                let _ = write!(out, "{}{at:#010x}:", if index == 0 { "" } else { "\n" });
            }
            self.must_be_mapped(at)?;
            let mut bytes = [0; 8];
            bytes[..size as usize].copy_from_slice(&self.debugger.bytes(at, size));
            let whole = u64::from_le_bytes(bytes);
            let signed = (whole as i64) << (64 - 8 * size) >> (64 - 8 * size);
            let _ = match (kind, size) {
                ('d', _) => write!(out, "\t{signed}"),
                ('u', _) => write!(out, "\t{whole}"),
                ('c', _) => write!(out, "\t{signed} {:?}", char::from(whole as u8)),
                ('f', 8) => write!(out, "\t{}", f64::from_bits(whole)),
                ('f', _) => write!(out, "\t{}", f32::from_bits(whole as u32)),
                _ => write!(out, "\t{whole:#0width$x}", width = 2 + 2 * size as usize),
            };
        }
        Ok(out + "\n")
    }

    fn must_be_mapped(&self, address: u32) -> Result<(), DebugError> {
        let is_mapped = self.debugger.session().target().is_mapped(GuestAddr::new(address));
        if is_mapped { Ok(()) } else { Err(format!("Cannot access memory at address {address:#x}").into()) }
    }

    fn instructions(&self, address: u32, count: u32, end: u32) -> String {
        let mut out = String::new();
        let here = self
            .debugger
            .frames(self.debugger.context())
            .get(self.debugger.frame())
            .map(|frame| frame.address.get());
        for line in disassembly(&self.debugger, address, end).take(count as usize) {
            let mark = if here == Some(line.0) { "=>" } else { "  " };
            let _ = writeln!(out, "{mark} {:#010x}: {}", line.0, line.1);
        }
        out
    }

    pub(super) fn look(&mut self, name: &str, rest: &str) -> Result<String, DebugError> {
        match name {
            "info" => self.info(rest),
            "backtrace" => Ok(backtrace(&self.debugger)),
            "frame" | "up" | "down" => {
                let frame = self.debugger.frame();
                let wanted = match name {
                    "up" => frame + 1,
                    "down" => {
                        frame.checked_sub(1).ok_or("Bottom (innermost) frame selected; you can't go down.")?
                    }
                    _ if rest.is_empty() => frame,
                    _ => rest.parse().map_err(|_| format!("`{rest}` is not the number of a frame"))?,
                };
                self.debugger.select(self.debugger.thread(), wanted)?;
                Ok(frame_line(&self.debugger, wanted))
            }
            "thread" => {
                if !rest.is_empty() {
                    let thread = rest.parse().ok().and_then(ThreadId::new);
                    let thread = thread.ok_or_else(|| format!("Invalid thread ID: {rest}"))?;
                    self.debugger.select(thread, 0)?;
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

    fn info(&self, what: &str) -> Result<String, DebugError> {
        let variables = |all: Vec<crate::debugger::ShownVariable>, none: &str| {
            let text: String = all.iter().map(|one| format!("{} = {}\n", one.name, one.text)).collect();
            if text.is_empty() { format!("{none}\n") } else { text }
        };
        let is = |name: &str| !what.is_empty() && name.starts_with(what);
        Ok(match what {
            _ if is("threads") => threads(&self.debugger),
            _ if is("breakpoints") || is("watchpoints") => breakpoints(&self.debugger),
            _ if is("args") => {
                let debugger = &self.debugger;
                let frame = debugger.frames(debugger.context()).into_iter().nth(debugger.frame());
                let all = frame.map_or(Vec::new(), |frame| debugger.arguments(&frame));
                let text: String = all.iter().map(|one| one.replacen('=', " = ", 1) + "\n").collect();
                if text.is_empty() { "No arguments.\n".to_owned() } else { text }
            }
            _ if is("display") => self.shown_all(),
            _ if is("locals") => {
                let is_real = self.debugger.session().can(Capability::ProcessorCode);
                let none = if is_real { NO_LOCALS } else { "No locals." };
                variables(self.debugger.locals(), none)
            }
            _ if is("registers") => registers(&self.debugger)?,
            _ if is("variables") => variables(self.debugger.globals(), "No variables."),
            _ if is("frame") => frame_line(&self.debugger, self.debugger.frame()),
            _ if is("line") => match self.debugger.present() {
                Some(place) => format!("Line {} of \"{}\"\n", place.line, file_name(&place.file)),
                None => "No line number information.\n".to_owned(),
            },
            _ if is("history") => {
                let (bytes, snapshots) = self.debugger.history();
                let seconds = seconds(self.debugger.now());
                format!(
                    "{snapshots} snapshots, {} KiB of memory in them; the present is {seconds:.6} s\n",
                    bytes / 1024
                )
            }
            _ => return Err("info threads|breakpoints|locals|variables|registers|line|frame|history".into()),
        })
    }

    fn list(&mut self, rest: &str) -> Result<String, DebugError> {
        let thread = self.debugger.thread();
        if !rest.is_empty() {
            let (found, _) = self.debugger.resolve(rest, Some(thread))?;
            self.listed = found.first().map_or(1, |one| one.line).saturating_sub(LINES / 2);
        }
        let model = self.debugger.programs().of(thread)?;
        let text = String::from_utf8_lossy(model.text()).into_owned();
        let first = self.listed.max(1);
        let lines = text.lines().enumerate().skip(first as usize - 1).take(LINES as usize);
        let out: String = lines.map(|(index, line)| format!("{}\t{}\n", index + 1, line)).collect();
        self.listed = first + LINES;
        if out.is_empty() { Err("Line number out of range.".into()) } else { Ok(out) }
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

/// A number in another base.
pub(crate) fn number_as(number: f64, format: &str) -> Result<String, DebugError> {
    let whole = number as i64;
    Ok(match format {
        "x" if whole < 0 => format!("{:#x}", whole as i32),
        "x" => format!("{whole:#x}"),
        "t" => format!("{:b}", whole as i32),
        "o" => format!("{whole:#o}"),
        "d" => whole.to_string(),
        "u" => (whole as u32).to_string(),
        "c" => format!("{whole} {:?}", char::from(whole as u8)),
        "f" => number.to_string(),
        _ => return Err(format!("Undefined output format \"{format}\".").into()),
    })
}

/// The instructions from an address on to another, each with its address.
fn disassembly<T: Target>(
    debugger: &Debugger<T>,
    address: u32,
    end: u32,
) -> impl Iterator<Item = (u32, String)> {
    let mut at = address & !3;
    std::iter::from_fn(move || {
        let (text, size) = debugger.session().target().disassemble(at).filter(|_| at < end)?;
        let line = (at, text);
        at = at.checked_add(size)?;
        Some(line)
    })
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
            format!("Breakpoint {ids}, ")
        }
        Reason::Changed { id, expression, old, new, by } => {
            format!(
                "Watchpoint {id}: {expression}\n\nOld value = {old}\nNew value = {new}\nWritten by {by}\n"
            )
        }
        Reason::Accessed { id, expression, access, old, value, by } => {
            let values = match old {
                Some(old) => format!("Old value = {old}\nNew value = {value}"),
                None => format!("Value = {value}"),
            };
            format!("{} {id}: {expression}\n\n{values}\nAccessed by {by}\n", access.title())
        }
        Reason::Trap(text) => format!("Trap: {text}\n"),
        Reason::Remark(text) => format!("Remark: {text}\n"),
        Reason::Started(thread) => format!("Thread {thread} begins.\n"),
        Reason::Ended(thread) => format!("Thread {thread} has ended.\n"),
        Reason::Console(text) => format!("Console: {text}\n"),
        Reason::Bit(text) => format!("Catchpoint: {text}\n"),
        Reason::When { id, expression } => format!("Catchpoint {id} (when {expression})\n"),
        Reason::AllEnded => {
            return format!("[All threads have ended, {at}]\n", at = who.rsplit(", ").next().unwrap_or(""));
        }
        Reason::Interrupted => "Interrupted\n".to_owned(),
        Reason::LinkLost(why) => format!("{why}\n"),
        Reason::BeginOfHistory => "No more reverse-execution history.\n".to_owned(),
        Reason::Begin | Reason::Step | Reason::Time => String::new(),
    };
    let Some(place) = place.filter(|_| stop.context.is_some()) else { return format!("{head}[{who}]\n") };
    format!(
        "{head}{} at {}:{} [{who}]\n{}",
        place.function,
        file_name(&place.file),
        place.line,
        source_line(debugger, &place)
    )
}

fn source_line<T: Target>(debugger: &Debugger<T>, place: &CodePlace) -> String {
    let text = debugger.programs().of(place.thread).ok().filter(|model| {
        model.path.file_name().and_then(|name| name.to_str()) == Some(file_name(&place.file))
    });
    let text = text.map(|model| String::from_utf8_lossy(model.text()).into_owned());
    let line = text.as_deref().and_then(|text| text.lines().nth(place.line as usize - 1));
    line.map_or_else(String::new, |line| format!("{}\t{line}\n", place.line))
}

fn backtrace<T: Target>(debugger: &Debugger<T>) -> String {
    let frames = debugger.frames(debugger.context());
    if frames.is_empty() {
        return "No stack.\n".to_owned();
    }
    (0..frames.len()).map(|index| frame_text(debugger, index)).collect()
}

fn frame_text<T: Target>(debugger: &Debugger<T>, index: usize) -> String {
    let frames = debugger.frames(debugger.context());
    let Some(frame) = frames.get(index) else { return "No stack.\n".to_owned() };
    match &frame.place {
        Some(place) => {
            let arguments = debugger.arguments(frame).join(", ");
            format!(
                "#{index}  {} ({arguments}) at {}:{}\n",
                place.function,
                file_name(&place.file),
                place.line
            )
        }
        None => format!("#{index}  {}\n", name_of(debugger, frame)),
    }
}

fn frame_line<T: Target>(debugger: &Debugger<T>, index: usize) -> String {
    let place = debugger.frames(debugger.context()).into_iter().nth(index).and_then(|frame| frame.place);
    let source = place.map_or_else(String::new, |place| source_line(debugger, &place));
    frame_text(debugger, index) + &source
}

/// The name of code that no program has: a function of the firmware, or its address.
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
        // A function of the firmware, then the place in the program that has called it.
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
