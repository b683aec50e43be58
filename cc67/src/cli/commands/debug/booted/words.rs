//! The commands of the debugger of a booted board: those of the other debugger that it has, as text in and text out.

use std::fmt::Write as _;

use cc67_debug::{BreakWords, LineReader, Said};
use cc67_host::remark;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::{Cycles, ThreadId, Ticks};
use runtime::debug::DebugInfo;
use runtime::{Event, EventKind};
use vm::dsp::packet_text;
use vm::engine::ContextId;

use super::super::talker::Talker;
use super::calls::is_of_program;
use super::debugger::{Debugger, Reason, ShownCall, Stop};
use super::programs::CodeLine;

/// Lines of the source shown at once, and packets around a place.
const LINES: u32 = 10;
const PACKETS: usize = 12;
/// Most registers in a line.
const COLUMNS: usize = 8;

/// The debugger with its commands.
pub(super) struct Shell {
    debugger: Debugger,
    infos: Vec<DebugInfo>,
    /// Whose program the board has stopped in.
    stood: Option<ContextId>,
    lines: LineReader,
    listed: u32,
    values: u32,
}

type Output<'a> = &'a mut dyn FnMut(&str);

impl Shell {
    pub(super) fn new(debugger: Debugger) -> Self {
        let infos = debugger.booted.debug().into_iter().map(|(_, info)| info).collect();
        Self { debugger, infos, stood: None, lines: LineReader::booted(), listed: 1, values: 0 }
    }

    /// Why nothing is known about some of the programs.
    pub(super) fn unknown(&self) -> impl Iterator<Item = String> {
        let all = self.debugger.programs.all().iter();
        all.filter_map(|known| Some(format!("thread {}: {}", known.thread, known.model.as_ref().err()?)))
    }

    /// Does what a line says; an empty one repeats the last.
    fn obey(&mut self, line: &str, output: Output<'_>) -> Result<Said, String> {
        let Some((name, rest)) = self.lines.read(line)? else { return Ok(Said::Text(String::new())) };
        let rest = rest.as_str();
        if name == "quit" {
            return Ok(Said::Quit);
        }
        let text = match name {
            "break" | "tbreak" => self.set_breakpoint(rest, name == "tbreak")?,
            "delete" => self.delete(rest)?,
            "print" | "ptype" | "set" => self.value(name, rest)?,
            "info" => self.info(rest)?,
            "backtrace" => {
                let context = self.stood.filter(|context| *context == ContextId::CALLBACK);
                self.backtrace(context.unwrap_or_else(|| self.debugger.context()))
            }
            "thread" => self.select(rest)?,
            "list" => self.list(rest)?,
            "disassemble" => self.disassemble()?,
            "help" => self.lines.help(),
            _ => self.travel(name, rest, output)?,
        };
        Ok(Said::Text(text))
    }

    /// The commands that let time pass.
    fn travel(&mut self, name: &str, rest: &str, output: Output<'_>) -> Result<String, String> {
        let infos = std::mem::take(&mut self.infos);
        let mut events = |event: Event| tell(&event, &infos, output);
        let stop = Self::go(&mut self.debugger, name, rest, &mut events);
        self.infos = infos;
        let stop = stop?;
        self.stood = stop.1;
        if let Some(thread) = stop.1.and_then(ContextId::thread) {
            self.debugger.thread = thread;
        }
        Ok(self.stopped(&stop))
    }

    fn go(
        debugger: &mut Debugger,
        name: &str,
        rest: &str,
        events: &mut dyn FnMut(Event),
    ) -> Result<Stop, String> {
        let count = || if rest.is_empty() { Ok(1) } else { rest.parse::<u64>().map_err(|_| number(rest)) };
        let now = debugger.booted.tick();
        Ok(match name {
            "run" => {
                debugger.restart();
                debugger.go(events)
            }
            "until" | "advance" => debugger.go_to(rest, events)?,
            "finish" => debugger.finish(events)?,
            "tick" => debugger.go_to_tick(Ticks::new(now.get() + count()?), events),
            "goto" => {
                let seconds: f64 = rest.parse().map_err(|_| number(rest))?;
                debugger.go_to_tick(Ticks::new((seconds / TIMEBASE).round().max(0.0) as u64), events)
            }
            _ => {
                let once = |debugger: &mut Debugger, events: &mut dyn FnMut(Event)| match name {
                    "continue" => debugger.go(events),
                    "step" | "next" => debugger.step(name == "step", events),
                    "stepi" => debugger.step_packet(events),
                    "reverse-continue" => debugger.reverse_go(),
                    _ => debugger.reverse_step(name == "reverse-step"),
                };
                let mut stop = once(debugger, events);
                for _ in 1..count()? {
                    if !matches!(stop.0, Reason::Step | Reason::Breakpoint(_)) {
                        break;
                    }
                    stop = once(debugger, events);
                }
                stop
            }
        })
    }

    fn set_breakpoint(&mut self, rest: &str, is_temporary: bool) -> Result<String, String> {
        let BreakWords { place, thread, condition } = BreakWords::of(rest);
        if place.is_empty() {
            return Err("`break` needs a line, a function or an address with `--boot`".to_owned());
        }
        let (id, place) = self.debugger.break_at(place, thread, (condition, is_temporary))?;
        Ok(format!("Breakpoint {id} at {place}\n"))
    }

    fn delete(&mut self, rest: &str) -> Result<String, String> {
        let id = if rest.is_empty() { None } else { Some(rest.parse().map_err(|_| number(rest))?) };
        let is_done = self.debugger.delete(id);
        if is_done { Ok(String::new()) } else { Err(format!("No breakpoint number {rest}.")) }
    }

    fn value(&mut self, name: &str, rest: &str) -> Result<String, String> {
        let (is_hex, rest) = match rest.strip_prefix("/x") {
            Some(rest) => (true, rest.trim()),
            None => (false, rest),
        };
        if name == "set" {
            let rest = rest.strip_prefix("variable ").or_else(|| rest.strip_prefix("var ")).unwrap_or(rest);
            let (place, value) = rest.split_once('=').ok_or("set var NAME = EXPRESSION")?;
            self.debugger.set(place.trim(), value.trim())?;
            return Ok(String::new());
        }
        let shown = self.debugger.evaluate(rest)?;
        if name == "ptype" {
            return Ok(format!("type = {}\n", shown.ty));
        }
        self.values += 1;
        let text = match shown.number {
            Some(number) if is_hex => format!("{:#x}", number as i64 as u32),
            _ => shown.text,
        };
        Ok(format!("${} = {text}\n", self.values))
    }

    fn info(&mut self, what: &str) -> Result<String, String> {
        let is = |name: &str| !what.is_empty() && name.starts_with(what);
        let debugger = &self.debugger;
        Ok(match what {
            _ if is("threads") => self.threads(),
            _ if is("breakpoints") => self.breakpoints(),
            _ if is("registers") => self.registers(),
            _ if is("locals") || is("args") => {
                return Err(
                    "where locals are in code for the processor is not noted; `info registers` shows \
                            the registers, and variables outside of functions have names"
                        .to_owned(),
                );
            }
            _ if is("line") => match debugger.place(debugger.context()) {
                Some(place) => format!("Line {} of \"{}\"\n", place.line, place.file),
                None => "No line number information.\n".to_owned(),
            },
            _ if is("frame") => {
                let frames = debugger.frames(debugger.context());
                frames.first().map_or_else(|| "No stack.\n".to_owned(), |frame| frame_text(0, frame))
            }
            _ if is("history") => {
                let (snapshots, first) = debugger.past();
                format!("{snapshots} snapshots, the first at {:.6} s\n", first.get() as f64 * TIMEBASE)
            }
            _ => return Err("info threads|breakpoints|registers|line|frame|history".to_owned()),
        })
    }

    fn threads(&self) -> String {
        let debugger = &self.debugger;
        let mut out = String::from("  Id   State       Frame\n");
        for known in debugger.programs.all() {
            let thread = known.thread;
            let mark = if thread == debugger.thread { '*' } else { ' ' };
            let is_active = debugger.booted.active().contains(&thread.get());
            let state = if is_active { "active" } else { "not active" };
            let frames = debugger.frames(ContextId::of(thread));
            let frames = frames.iter().take_while(|frame| frame.firmware.is_some()).count() + 1;
            let shown = debugger.frames(ContextId::of(thread));
            let shown: Vec<_> = shown.iter().take(frames).map(words_of).collect();
            let _ = writeln!(out, "{mark} {:<4} {state:<11} {}", thread.to_string(), shown.join(" from "));
        }
        let _ =
            writeln!(out, "  tick {}, {:.6} s", debugger.booted.tick().get(), seconds(debugger.booted.now()));
        out
    }

    fn breakpoints(&self) -> String {
        let all = self.debugger.breakpoints();
        if all.is_empty() {
            return "No breakpoints.\n".to_owned();
        }
        let line =
            |one: &super::debugger::Breakpoint| format!("{:<4} {}, hits {}\n", one.id, one.text, one.hits);
        all.iter().map(line).collect()
    }

    fn registers(&self) -> String {
        let registers = self.debugger.booted.board.registers();
        let rows = registers.chunks(COLUMNS).map(|row| {
            let cells: Vec<_> = row.iter().map(|(name, value)| format!("{name}={value:08X}")).collect();
            cells.join(" ") + "\n"
        });
        let doing = self.debugger.booted.board.doing();
        let head = format!("next packet 0x{:08X}, of thread {}\n", doing.pc, doing.thread.unwrap_or(0));
        head + &rows.collect::<String>()
    }

    fn backtrace(&self, context: ContextId) -> String {
        let frames = self.debugger.frames(context);
        if frames.is_empty() {
            return "No stack.\n".to_owned();
        }
        frames.iter().enumerate().map(|(index, frame)| frame_text(index, frame)).collect()
    }

    fn select(&mut self, rest: &str) -> Result<String, String> {
        if !rest.is_empty() {
            let thread = rest.parse().ok().and_then(ThreadId::new);
            self.debugger.thread = thread.ok_or_else(|| format!("Invalid thread ID: {rest}"))?;
        }
        let frames = self.debugger.frames(self.debugger.context());
        let text = frames.first().map_or_else(|| "No stack.\n".to_owned(), |frame| frame_text(0, frame));
        Ok(format!("[Current thread is {}]\n{text}", self.debugger.thread))
    }

    fn list(&mut self, rest: &str) -> Result<String, String> {
        let known = self.debugger.programs.of(self.debugger.thread).ok_or("No program.")?;
        if !rest.is_empty() {
            let found = self.debugger.programs.resolve(rest, Some(self.debugger.thread))?;
            let line = found.first().and_then(|at| self.debugger.programs.place(*at));
            self.listed = line.map_or(1, |place| place.line).saturating_sub(LINES / 2).max(1);
        }
        let model = known.model.as_ref().map_err(Clone::clone)?;
        let text = String::from_utf8_lossy(model.text()).into_owned();
        let lines = text.lines().enumerate().skip(self.listed as usize - 1).take(LINES as usize);
        let out: String = lines.map(|(index, line)| format!("{}\t{line}\n", index + 1)).collect();
        self.listed += LINES;
        if out.is_empty() { Err("Line number out of range.".to_owned()) } else { Ok(out) }
    }

    /// The packets from where the thread is.
    fn disassemble(&self) -> Result<String, String> {
        let frames = self.debugger.frames(self.debugger.context());
        let here = frames.iter().find(|frame| is_of_program(frame.at)).ok_or("No frame selected.")?.at;
        let memory = self.debugger.booted.board.memory();
        let word = |at: u32| Some(memory.peek::<u32>(kmotiondef::GuestAddr::new(at)));
        let (mut out, mut at) = (String::new(), here);
        for _ in 0..PACKETS {
            let text = packet_text(at, word);
            let mark = if at == here { "=>" } else { "  " };
            let _ = writeln!(out, "{mark} {at:#010x}: {text}");
            at += 4 * (text.matches(" || ").count() as u32 + 1);
        }
        Ok(out)
    }

    /// Why the board stands, and where.
    fn stopped(&mut self, (reason, context): &Stop) -> String {
        let at = format!("{:.6} s", seconds(self.debugger.booted.now()));
        let who = match context.map(ContextId::thread) {
            Some(Some(thread)) => format!("thread {thread}, {at}"),
            Some(None) => format!("call-back, {at}"),
            None => at.clone(),
        };
        let head = match reason {
            Reason::Breakpoint(id) => format!("Breakpoint {id}, "),
            Reason::Ended(thread) => format!("Thread {thread} has ended.\n"),
            Reason::AllEnded => return format!("[All threads have ended, {at}]\n"),
            Reason::Interrupted => "Interrupted\n".to_owned(),
            Reason::Crashed(text) => format!("{}\n", text.trim_end()),
            Reason::BeginOfHistory => "No more reverse-execution history.\n".to_owned(),
            Reason::Step | Reason::Time => String::new(),
        };
        let place = context.and_then(|context| self.debugger.place(context));
        let Some(place) = place else { return format!("{head}[{who}]\n") };
        self.listed = place.line.saturating_sub(LINES / 2).max(1);
        let CodeLine { function, file, line, .. } = &place;
        let known = self.debugger.programs.of(place.thread);
        let source = known.and_then(|known| known.source_line(&place));
        let source = source.map_or_else(String::new, |text| format!("{line}\t{text}\n"));
        format!("{head}{function} at {file}:{line} [{who}]\n{source}")
    }
}

impl Talker for Shell {
    fn command(&mut self, line: &str, output: Output<'_>) -> Result<Said, String> {
        self.obey(line, output)
    }

    fn complete(&self, line: &str) -> Vec<String> {
        let word = line.trim_start();
        self.lines.names().filter(|name| name.starts_with(word)).map(str::to_owned).collect()
    }
}

fn number(text: &str) -> String {
    format!("`{text}` is not a number")
}

/// Board time in seconds.
fn seconds(at: Cycles) -> f64 {
    at.get() as f64 / Cycles::PER_SECOND.get() as f64
}

fn words_of(frame: &ShownCall) -> String {
    match (&frame.firmware, &frame.place) {
        (Some(name), _) => format!("{name} () of the firmware"),
        (None, Some(place)) => format!("{} () at {}:{}", place.function, place.file, place.line),
        (None, None) => format!("{:#010x}", frame.at),
    }
}

fn frame_text(index: usize, frame: &ShownCall) -> String {
    format!("#{index}  {}\n", words_of(frame))
}

/// Shows what the board says while it runs.
fn tell(event: &Event, infos: &[DebugInfo], output: Output<'_>) {
    if let EventKind::ConsoleLine(line) = &event.kind {
        output(&format!("{}\n", String::from_utf8_lossy(line)));
    } else if let Some(text) = remark::describe(event, infos) {
        output(&format!("cc67: {text}\n"));
    }
}
