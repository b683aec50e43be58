//! The Debug Adapter Protocol: a debugger for editors.
//!
//! A client sends requests, each of which has one response; changes of the board's state are sent as events. The
//! protocol is served over any two streams. A separate thread reads requests, so that one can interrupt a run;
//! everything else happens in order.
//!
//! Source: <https://microsoft.github.io/debug-adapter-protocol/specification>.

mod attach;
mod breakpoints;
mod connected;
mod door;
mod launch;
mod look;
mod relay;
mod wire;

pub use attach::AttachPoint;
pub use door::{Editor, editors};
pub use launch::Launch;

use std::io::{self, BufRead, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use cc67_host::{Target, remark};
use runtime::{Event, EventKind};
use serde_json::{Value, json};
use vm::engine::ContextId;

use crate::debugger::{DebugError, Debugger, Goal, ONLY_FORWARD, Reason, StepKind, Stop};
use crate::early::EarlyLines;
use crate::shell::{CommandOutput, Shell};
use crate::words::{command_of, is_move};
use look::Handle;
use wire::ClientWire;

/// The number of the call-back in the protocol, after the numbers of the threads.
const CALLBACK: i64 = 8;

/// The body of a response, or the message of a failed one.
type Reply = Result<Value, DebugError>;

/// A function that creates a debugger from a client's launch request.
pub type Launcher<'a, T> = &'a mut dyn FnMut(&Launch) -> Result<Debugger<T>, String>;

/// Serves one client until it disconnects or its connection is lost.
///
/// # Errors
/// Writing to the client failed.
pub fn serve<T: Target>(
    input: impl BufRead + Send + 'static,
    output: impl Write,
    launcher: Launcher<'_, T>,
) -> io::Result<()> {
    let interrupt = Arc::new(AtomicBool::new(false));
    let requests = read(input, Arc::clone(&interrupt));
    let mut server = Server::new(output, Some(launcher), interrupt);
    let mut greeting = Value::Null;
    while let Ok(request) = requests.recv() {
        match request["command"].as_str() {
            Some("initialize") => greeting = request.clone(),
            Some("attach") => match relay::connect(&request["arguments"], &greeting) {
                Ok(board) => return relay::relay(board, requests, server.wire, &request),
                Err(error) => {
                    server.wire.respond(&request, Err(error))?;
                    continue;
                }
            },
            _ => {}
        }
        server.answer(&request)?;
        if server.is_over {
            break;
        }
    }
    Ok(())
}

/// Reads requests; a request to stop a run interrupts it at once, as does the end of the stream.
fn read(mut input: impl BufRead + Send + 'static, interrupt: Arc<AtomicBool>) -> Receiver<Value> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        while let Some(request) = wire::read(&mut input) {
            let command = request.get("command").and_then(Value::as_str).unwrap_or_default();
            if matches!(command, "pause" | "disconnect" | "terminate" | "restart") {
                interrupt.store(true, Ordering::Relaxed);
            }
            if sender.send(request).is_err() {
                return;
            }
        }
        interrupt.store(true, Ordering::Relaxed);
    });
    receiver
}

/// The state of a conversation.
struct Server<'a, W, T: Target> {
    wire: ClientWire<W>,
    /// The function that creates a debugger; `None` for an existing board, which has a debugger from the beginning.
    launcher: Option<Launcher<'a, T>>,
    /// The goal of a run on an existing board; `None` while it is stopped.
    goal: Option<Goal>,
    interrupt: Arc<AtomicBool>,
    /// The debugger, with the commands of the terminal.
    shell: Option<Shell<T>>,
    /// Lines that were reported before the board sent them.
    early: EarlyLines,
    asked: Launch,
    /// The meanings of the variable references during the present stop.
    handles: Vec<Handle>,
    /// The breakpoints that the client has set, each with the client's name for its set.
    set: Vec<(String, u32)>,
    has_trapped: bool,
    is_over: bool,
}

/// A movement of the board that a client requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MoveRequest {
    Forward(StepKind),
    Back,
    BackInstruction,
    BackOn,
    Again,
}

impl<'a, W: Write, T: Target> Server<'a, W, T> {
    fn new(output: W, launcher: Option<Launcher<'a, T>>, interrupt: Arc<AtomicBool>) -> Self {
        Self {
            wire: ClientWire::new(output),
            launcher,
            goal: Some(Goal::None),
            interrupt,
            shell: None,
            early: EarlyLines::default(),
            asked: Launch::default(),
            handles: Vec::new(),
            set: Vec::new(),
            has_trapped: false,
            is_over: false,
        }
    }
}

impl<W: Write, T: Target> Server<'_, W, T> {
    fn answer(&mut self, request: &Value) -> io::Result<()> {
        let command = request["command"].as_str().unwrap_or_default().to_owned();
        let arguments = &request["arguments"];
        if let Some(kind) = self.move_of(&command, arguments) {
            return self.do_move(request, kind);
        }
        if command == "evaluate"
            && let Some(line) = self.command_in(arguments)
        {
            return self.command(request, &line);
        }
        if matches!(command.as_str(), "disconnect" | "terminate") && self.launcher.is_some() {
            self.kill_launched(arguments)?;
        }
        let reply = self.reply(&command, arguments);
        let is_ok = reply.is_ok();
        self.wire.respond(request, reply)?;
        match command.as_str() {
            "launch" | "attach" if is_ok => self.wire.event("initialized", json!({})),
            "configurationDone" if is_ok => self.begin(),
            "disconnect" | "terminate" => {
                self.is_over = command == "disconnect";
                if self.is_over { Ok(()) } else { self.wire.event("terminated", json!({})) }
            }
            "setVariable" | "setExpression" | "writeMemory" | "evaluate" => self.tell_messages(),
            "pause" if self.launcher.is_none() => self.halt(Reason::Interrupted),
            "pause" => {
                // The run was already interrupted; a stopped board stays stopped.
                self.interrupt.store(false, Ordering::Relaxed);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn move_of(&self, command: &str, arguments: &Value) -> Option<MoveRequest> {
        let is_instruction = arguments["granularity"] == "instruction";
        Some(match command {
            "continue" => MoveRequest::Forward(StepKind::Continue),
            "next" | "stepIn" if is_instruction => MoveRequest::Forward(StepKind::Instruction),
            "next" => MoveRequest::Forward(StepKind::Over),
            "stepIn" => MoveRequest::Forward(StepKind::Into),
            "stepOut" => MoveRequest::Forward(StepKind::Out),
            "stepBack" if is_instruction => MoveRequest::BackInstruction,
            "stepBack" => MoveRequest::Back,
            "reverseContinue" => MoveRequest::BackOn,
            "restart" => MoveRequest::Again,
            _ => return None,
        })
    }

    /// The response to a request during which no time passes.
    fn reply(&mut self, command: &str, arguments: &Value) -> Reply {
        match command {
            "initialize" => Ok(launch::capabilities(self.launcher.is_some())),
            "launch" => self.launch(arguments),
            "attach" => self.attach(arguments),
            "configurationDone" | "pause" | "disconnect" | "terminate" => Ok(json!({})),
            "setBreakpoints" => self.set_breakpoints(arguments),
            "setFunctionBreakpoints" => self.set_function_breakpoints(arguments),
            "setInstructionBreakpoints" => self.set_instruction_breakpoints(arguments),
            "setDataBreakpoints" => self.set_data_breakpoints(arguments),
            "setExceptionBreakpoints" => self.set_exception_breakpoints(arguments),
            "dataBreakpointInfo" => self.data_breakpoint_info(arguments),
            "breakpointLocations" => self.breakpoint_locations(arguments),
            "threads" => self.threads(),
            "stackTrace" => self.stack_trace(arguments),
            "scopes" => self.scopes(arguments),
            "variables" => self.variables(arguments),
            "evaluate" => self.evaluate(arguments),
            "setVariable" => self.set_variable(arguments),
            "setExpression" => self.set_expression(arguments),
            "completions" => self.completions(arguments),
            "disassemble" => self.disassemble(arguments),
            "readMemory" => self.read_memory(arguments),
            "writeMemory" => self.write_memory(arguments),
            "exceptionInfo" => self.exception_info(),
            "loadedSources" => Ok(json!({ "sources": [] })),
            _ => Err(format!("cc67 does not know the request `{command}`").into()),
        }
    }

    fn launch(&mut self, arguments: &Value) -> Reply {
        self.asked = Launch(arguments.clone());
        let launcher = self.launcher.as_mut();
        let launcher = launcher.ok_or("a board runs here already; use \"request\": \"attach\"")?;
        let mut debugger = launcher(&self.asked)?;
        debugger.interrupted_by(Arc::clone(&self.interrupt));
        self.shell = Some(Shell::new(debugger));
        Ok(json!({}))
    }

    fn attach(&mut self, arguments: &Value) -> Reply {
        self.asked = Launch(arguments.clone());
        let debugger = self.debugger()?;
        debugger.look_around();
        Ok(json!({}))
    }

    fn debugger(&mut self) -> Result<&mut Debugger<T>, DebugError> {
        let shell = self.shell.as_mut().ok_or("nothing is launched yet")?;
        Ok(shell.debugger_mut())
    }

    /// Handles the end of the client's configuration: the board runs, or reports a stop at its beginning.
    fn begin(&mut self) -> io::Result<()> {
        if self.asked.0["stopOnEntry"] == true {
            let stop = self.shell.as_ref().map(|shell| shell.debugger().stop().clone());
            if self.launcher.is_none() {
                return self.halt(Reason::Begin);
            }
            return stop.map_or(Ok(()), |stop| self.tell_stop(&stop));
        }
        if self.launcher.is_none() {
            return Ok(());
        }
        let first = self.first_move()?;
        let result = self.run(first)?;
        self.tell_result(result)
    }

    /// Stops an existing board where it is.
    fn halt(&mut self, reason: Reason) -> io::Result<()> {
        if self.goal.take().is_none() {
            return Ok(());
        }
        let stop = self.shell.as_mut().map(|shell| shell.debugger_mut().halt(reason));
        stop.map_or(Ok(()), |stop| self.tell_stop(&stop))
    }

    /// Begins a movement of an existing board; it continues while the owner lets time pass.
    fn let_go(&mut self, kind: MoveRequest) -> io::Result<()> {
        self.handles.clear();
        let goal = match kind {
            MoveRequest::Forward(way) => self.debugger().and_then(|debugger| debugger.goal(way)),
            MoveRequest::Back | MoveRequest::BackInstruction | MoveRequest::BackOn | MoveRequest::Again => {
                Err(ONLY_FORWARD.into())
            }
        };
        match goal {
            Ok(goal) => {
                self.goal = Some(goal);
                Ok(())
            }
            Err(error) => self.tell_result(Err(error)),
        }
    }

    fn do_move(&mut self, request: &Value, kind: MoveRequest) -> io::Result<()> {
        if kind == MoveRequest::Again {
            self.interrupt.store(false, Ordering::Relaxed);
        }
        let thread = request["arguments"]["threadId"].as_i64();
        let chosen = self.debugger().and_then(|debugger| {
            let thread =
                thread.and_then(|number| i32::try_from(number).ok()).and_then(kmotiondef::ThreadId::new);
            match thread {
                Some(thread) if debugger.thread() != thread => debugger.select(thread, 0),
                Some(thread) => debugger.select(thread, 0),
                None => Ok(()),
            }
        });
        if let Err(error) = chosen {
            return self.wire.respond(request, Err(error));
        }
        self.wire.respond(request, Ok(json!({ "allThreadsContinued": true })))?;
        if self.launcher.is_none() {
            return self.let_go(kind);
        }
        let result = self.run(kind)?;
        self.tell_result(result)
    }

    fn tell_result(&mut self, result: Result<Stop, DebugError>) -> io::Result<()> {
        match result {
            Ok(stop) => self.tell_stop(&stop),
            Err(error) => {
                self.wire.output("console", &format!("{error}\n"))?;
                let Some(stop) = self.shell.as_ref().map(|shell| shell.debugger().stop().clone()) else {
                    return Ok(());
                };
                self.tell_stop(&Stop { reason: Reason::Step, ..stop })
            }
        }
    }

    /// Runs the board; console lines are reported at once.
    fn run(&mut self, kind: MoveRequest) -> io::Result<Result<Stop, DebugError>> {
        self.handles.clear();
        let Some(shell) = &mut self.shell else { return Ok(Err("nothing is launched yet".into())) };
        let debugger = shell.debugger_mut();
        let is_forward = matches!(kind, MoveRequest::Forward(_) | MoveRequest::Again);
        let mut herald = OutputReporter::new(&mut self.wire, &mut self.early, debugger);
        let mut tell = |event: &Event| herald.report(event);
        let result = match kind {
            MoveRequest::Forward(StepKind::Continue) => Ok(debugger.go_on(&mut tell)),
            MoveRequest::Forward(StepKind::Into) => debugger.step(&mut tell),
            MoveRequest::Forward(StepKind::Over) => debugger.next(&mut tell),
            MoveRequest::Forward(StepKind::Out) => debugger.finish(&mut tell),
            MoveRequest::Forward(StepKind::Instruction) => debugger.step_instruction(&mut tell),
            MoveRequest::Back => debugger.reverse_next(),
            MoveRequest::BackInstruction => Ok(debugger.reverse_step_instruction()),
            MoveRequest::BackOn => Ok(debugger.reverse_continue()),
            MoveRequest::Again => debugger.start_again().map(|()| debugger.go_on(&mut tell)),
        };
        let OutputReporter { failed, has_trapped, late, .. } = herald;
        self.has_trapped |= has_trapped;
        if let Some(error) = failed {
            return Err(error);
        }
        self.tell_early(is_forward)?;
        if !late.is_empty() {
            self.wire.output("console", &late)?;
        }
        Ok(result)
    }

    /// Reports the lines that programs have printed and the board has not sent yet.
    fn tell_early(&mut self, is_forward: bool) -> io::Result<()> {
        let Some(shell) = &self.shell else { return Ok(()) };
        let unsent = shell.debugger().session().target().unsent_lines();
        if !is_forward {
            self.early.go_back(unsent);
            return Ok(());
        }
        for line in self.early.show(unsent) {
            self.wire.output("stdout", &format!("{}\n", String::from_utf8_lossy(&line)))?;
        }
        Ok(())
    }

    /// Executes a terminal command typed in an editor's console, and informs the editor if the board has moved.
    fn command(&mut self, request: &Value, line: &str) -> io::Result<()> {
        let is_move = command_of(line).is_some_and(is_move);
        if is_move && self.launcher.is_none() {
            let text = format!("`{line}`: others use this board; the buttons of the editor continue it");
            return self.wire.respond(request, Err(text.into()));
        }
        let Some(shell) = &mut self.shell else {
            return self.wire.respond(request, Err("nothing is launched yet".into()));
        };
        let (wire, mut failed) = (&mut self.wire, None);
        let said = shell.command(line, &mut |text| {
            let category = if text.starts_with("cc67: ") { "console" } else { "stdout" };
            failed = failed.take().or(wire.output(category, text).err());
        });
        if let Some(error) = failed {
            return Err(error);
        }
        let is_done = said.is_ok();
        let reply = said.map(|said| {
            let text = if let CommandOutput::Text(text) = said { text } else { String::new() };
            json!({ "result": text.trim_end(), "variablesReference": 0 })
        });
        self.wire.respond(request, reply)?;
        self.tell_messages()?;
        let stop = self.shell.as_ref().map(|shell| shell.debugger().stop().clone());
        match stop.filter(|_| is_move && is_done) {
            Some(stop) => {
                self.handles.clear();
                let thread = number_of(stop.context.unwrap_or(ContextId::CALLBACK));
                self.wire.event("continued", json!({ "threadId": thread, "allThreadsContinued": true }))?;
                self.tell_stop(&stop)
            }
            None => Ok(()),
        }
    }

    /// The terminal command typed in an editor's console; `None` for an expression.
    fn command_in(&mut self, arguments: &Value) -> Option<String> {
        let text = arguments["expression"].as_str().filter(|_| arguments["context"] == "repl")?.trim();
        if let Some(command) = text.strip_prefix("-exec ") {
            return Some(command.trim().to_owned());
        }
        // A variable takes precedence over a command with the same name.
        command_of(text)?;
        let is_expression = self.debugger().is_ok_and(|debugger| debugger.evaluate(text).is_ok());
        (!is_expression).then(|| text.to_owned())
    }

    fn tell_messages(&mut self) -> io::Result<()> {
        while let Some(message) = self.shell.as_mut().and_then(|shell| shell.debugger_mut().take_message()) {
            self.wire.output("console", &format!("{message}\n"))?;
        }
        Ok(())
    }

    fn tell_stop(&mut self, stop: &Stop) -> io::Result<()> {
        self.tell_messages()?;
        let Some(debugger) = self.shell.as_ref().map(Shell::debugger) else { return Ok(()) };
        if stop.reason == Reason::AllEnded && self.asked.0["stopAtEnd"] != true {
            let code = if self.has_trapped { 3 } else { 0 };
            self.wire.event("exited", json!({ "exitCode": code }))?;
            return self.wire.event("terminated", json!({}));
        }
        let thread = match stop.context {
            Some(context) => number_of(context),
            None => number_of(debugger.context()),
        };
        let seconds = crate::shell::seconds(stop.at);
        let (reason, text) = match &stop.reason {
            Reason::Begin => ("entry", String::new()),
            Reason::Breakpoint(_) => ("breakpoint", String::new()),
            Reason::Changed { expression, old, new, by, .. } => {
                ("data breakpoint", format!("{expression}: {old} → {new}, written by {by}"))
            }
            Reason::Accessed { expression, old, value, by, .. } => {
                let before = old.as_ref().map_or_else(String::new, |old| format!("{old} → "));
                ("data breakpoint", format!("{expression}: {before}{value}, accessed by {by}"))
            }
            Reason::Step | Reason::Time => ("step", String::new()),
            Reason::Trap(text) | Reason::Remark(text) => ("exception", text.clone()),
            Reason::Interrupted => ("pause", String::new()),
            Reason::LinkLost(why) => ("exception", why.clone()),
            Reason::BeginOfHistory => ("step", "the beginning of the recorded past".to_owned()),
            Reason::AllEnded => ("pause", "all threads have ended".to_owned()),
            Reason::Started(thread) => ("pause", format!("thread {thread} begins")),
            Reason::Ended(thread) => ("pause", format!("thread {thread} has ended")),
            Reason::Console(text) | Reason::Bit(text) => ("pause", text.clone()),
            Reason::When { expression, .. } => ("data breakpoint", format!("{expression} is true")),
        };
        let mut body = json!({
            "reason": reason,
            "threadId": thread,
            "allThreadsStopped": true,
            "description": format!("Paused on {reason} at {seconds:.6} s of board time"),
        });
        if !text.is_empty() {
            body["text"] = json!(text);
        }
        if let Reason::Breakpoint(ids) = &stop.reason {
            body["hitBreakpointIds"] = json!(ids);
        }
        if let Reason::Changed { id, .. } | Reason::Accessed { id, .. } | Reason::When { id, .. } =
            &stop.reason
        {
            body["hitBreakpointIds"] = json!([id]);
        }
        self.wire.event("stopped", body)
    }
}

/// Reports the board's output to a client while it runs.
struct OutputReporter<'a, W> {
    wire: &'a mut ClientWire<W>,
    /// Lines that have already been reported.
    early: &'a mut EarlyLines,
    /// The text of traps: it is reported after the output that preceded them.
    late: String,
    infos: Vec<runtime::debug::DebugInfo>,
    failed: Option<io::Error>,
    has_trapped: bool,
}

impl<'a, W: Write> OutputReporter<'a, W> {
    fn new<T: Target>(
        wire: &'a mut ClientWire<W>,
        early: &'a mut EarlyLines,
        debugger: &Debugger<T>,
    ) -> Self {
        let infos = debugger.session().debug().into_iter().map(|(_, info)| info).collect();
        Self { wire, early, late: String::new(), infos, failed: None, has_trapped: false }
    }

    fn report(&mut self, event: &Event) {
        self.has_trapped |= matches!(event.kind, EventKind::Trap(_));
        let told = match &event.kind {
            EventKind::ConsoleLine(line) if self.early.take(line) => Ok(()),
            EventKind::ConsoleLine(line) => {
                self.wire.output("stdout", &format!("{}\n", String::from_utf8_lossy(line)))
            }
            _ => match remark::describe(event, &self.infos) {
                Some(text) => {
                    let scene = remark::scene(event).map_or(String::new(), ToString::to_string);
                    let text = format!("{text}\n{scene}");
                    if matches!(event.kind, EventKind::Trap(_)) {
                        self.late += &text;
                        return;
                    }
                    self.wire.output("console", &text)
                }
                None => Ok(()),
            },
        };
        self.failed = self.failed.take().or(told.err());
    }
}

/// The number of a context in the protocol.
fn number_of(context: ContextId) -> i64 {
    context.thread().map_or(CALLBACK, |thread| i64::from(thread.get()))
}
