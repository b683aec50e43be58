//! `cc67 debug`: a debugger in the terminal, from a script, or for an editor.

mod terminal;

use std::cell::RefCell;
use std::ffi::OsString;
use std::io::{self, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::rc::Rc;

use anyhow::{Context, Result};
use cc67_debug::dap::{self, Launch};
use cc67_debug::{CommandOutput, Debugger, Shell};
use cc67_host::{AnyTarget, Capability, Target};
use clap::{Args, Parser};
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

use crate::cli::args::board::{BoardArguments, canonical_words};
use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::engine::EngineName;
use crate::cli::args::sidecars::{SidecarArguments, Sidecars};
use crate::cli::args::time::seconds;
use crate::cli::io::exit::Exit;
use crate::cli::io::input::read;
use crate::cli::io::{output, terminal as screen};
use crate::cli::session::{Setup, StartPlan};

/// The default end of a run: an hour of board time.
const LIMIT: f64 = 3600.0;

/// Arguments of `cc67 debug`.
#[derive(Debug, Args)]
#[command(mut_arg("engine", EngineName::debuggable))]
pub(super) struct DebugArguments {
    /// Sources or images: FILE runs in the lowest free thread, N:FILE in thread N
    #[arg(required_unless_present_any = ["explain", "dap", "listen"], value_name = "[N:]FILE")]
    programs: Vec<OsString>,
    /// Take commands from a file (`-`: stdin); stop at the first invalid command
    #[arg(long, value_name = "FILE")]
    batch: Option<PathBuf>,
    /// Speak the Debug Adapter Protocol with an editor, over stdin and stdout or with one client of a TCP port
    #[arg(long, value_name = "PORT", num_args = 0..=1, require_equals = false, default_missing_value = "0")]
    dap: Option<u16>,
    /// Speak the Debug Adapter Protocol with successive clients of a TCP port
    #[arg(long, value_name = "PORT", conflicts_with_all = ["dap", "batch"])]
    listen: Option<u16>,
    /// Stop after SECONDS of board time
    #[arg(long = "for", alias = "until", value_name = "SECONDS", value_parser = seconds)]
    limit: Option<f64>,
    #[command(flatten)]
    sidecars: SidecarArguments,
    #[command(flatten)]
    board: BoardArguments,
    #[command(flatten)]
    compiler: CompilerArguments,
    /// The words after `debug` on the command line.
    #[arg(skip)]
    pub(super) words: Vec<OsString>,
}

impl DebugArguments {
    /// The programs, if the files next to them should be used.
    pub(super) fn with_sidecars(&self) -> Option<&[OsString]> {
        (!self.sidecars.no_sidecar).then_some(&self.programs)
    }
}

/// The arguments as a client of the protocol gives them.
#[derive(Debug, Parser)]
#[command(name = "launch", no_binary_name = true, args_override_self = true)]
struct LaunchArguments {
    #[command(flatten)]
    debug: DebugArguments,
    /// For `--explain` of the whole command, which nobody gives here.
    #[arg(long, hide = true)]
    explain: Option<String>,
}

impl LaunchArguments {
    /// Parses the words, and adds the files next to the first program, as on a command line.
    fn with_sidecars(words: &[OsString]) -> Result<Self> {
        let arguments = Self::try_parse_from(words)?;
        let Some(programs) = arguments.debug.with_sidecars() else { return Ok(arguments) };
        let sidecars = Sidecars::of("debug", programs, words, |option| super::is_option_of("debug", option))?;
        Ok(Self::try_parse_from([&sidecars.options, words, &sidecars.also].concat())?)
    }
}

/// Debugs programs.
pub(super) fn debug(arguments: &DebugArguments) -> Result<Exit> {
    anyhow::ensure!(
        arguments.programs.is_empty() || arguments.dap.is_none() && arguments.listen.is_none(),
        "with `--dap` and `--listen` the editor names the programs: leave them out"
    );
    match (arguments.dap, arguments.listen) {
        (Some(0), _) => {
            let mut launch = |request: &Launch| launch(arguments, request);
            dap::serve(BufReader::new(io::stdin()), io::stdout(), &mut launch)?;
            return Ok(Exit::Success);
        }
        (Some(port), _) => return listen(arguments, port, true),
        (None, Some(port)) => return listen(arguments, port, false),
        (None, None) => {}
    }
    let Some(debugger) = debugger(arguments)? else { return Ok(Exit::Failure) };
    run_session(debugger, arguments)
}

/// Reads commands from a file or a user.
fn run_session<T: Target + 'static>(debugger: Debugger<T>, arguments: &DebugArguments) -> Result<Exit> {
    let shell = Shell::new(debugger);
    for why in shell.debugger().programs().unknown() {
        screen::note(&why);
    }
    let shell = Rc::new(RefCell::new(shell));
    let exit = match &arguments.batch {
        Some(path) => execute_file(&mut shell.borrow_mut(), path),
        None => terminal::run_interactive(&shell),
    };
    note_active(&shell.borrow());
    exit
}

/// Reports the threads that continue on a target whose time passes by itself.
fn note_active<T: Target>(shell: &Shell<T>) {
    let session = shell.debugger().session();
    if session.can(Capability::StopTime) {
        return;
    }
    let programs = session.programs().iter().map(|program| program.thread);
    let programs = programs.filter(|_| session.target().loss_reason().is_none());
    for thread in programs.filter(|thread| session.thread(*thread).is_active()) {
        screen::note(&format!("thread {thread} continues on the controller; `kill {thread}` stops it"));
    }
}

/// Creates the setup for the arguments; `None` if a program has errors, which have been reported.
fn setup(arguments: &DebugArguments) -> Result<Option<Setup>> {
    let started = StartPlan { programs: &arguments.programs, first: &arguments.sidecars.first };
    Setup::new(started, &arguments.board, &arguments.compiler)
}

/// The latest tick at which a run ends.
fn limit(arguments: &DebugArguments) -> Ticks {
    Ticks::new((arguments.limit.unwrap_or(LIMIT) / TIMEBASE).round() as u64)
}

/// A debugger for the programs; `None` if one has errors, which have been reported.
fn debugger(arguments: &DebugArguments) -> Result<Option<Debugger<AnyTarget>>> {
    let Some(setup) = setup(arguments)? else { return Ok(None) };
    Ok(Some(Debugger::new(setup.for_debugger()?, limit(arguments))))
}

/// Executes the commands of a file.
fn execute_file<T: Target>(shell: &mut Shell<T>, path: &std::path::Path) -> Result<Exit> {
    let text =
        if path.as_os_str() == "-" { io::read_to_string(io::stdin())?.into_bytes() } else { read(path)? };
    for line in String::from_utf8_lossy(&text).lines() {
        // In a script, an empty line does not repeat the last command.
        if line.trim().is_empty() {
            continue;
        }
        let answer = shell
            .command(line, &mut |text| show(text))
            .map_err(|error| anyhow::anyhow!("`{line}`: {error}"))?;
        match answer {
            CommandOutput::Text(text) => output::print(&text)?,
            CommandOutput::Quit => break,
        }
    }
    Ok(Exit::Success)
}

/// Shows the board's output during a run; a write error is ignored.
fn show(text: &str) {
    match text.strip_prefix("cc67: ") {
        Some(remark) => screen::note(remark.trim_end()),
        None => _ = io::stdout().write_all(text.as_bytes()),
    }
}

/// Serves clients at a port of this computer.
fn listen(arguments: &DebugArguments, port: u16, is_once: bool) -> Result<Exit> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .with_context(|| format!("cannot listen on port {port}"))?;
    screen::note(&format!("debugger: waiting for an editor on {}", listener.local_addr()?));
    let editors = dap::editors(listener).context("debugger")?;
    loop {
        let stream = editors.recv().context("debugger")?.into_stream();
        stream.set_nodelay(true)?;
        let mut launch = |request: &Launch| launch(arguments, request);
        let served = dap::serve(BufReader::new(stream.try_clone()?), stream, &mut launch);
        if let Err(error) = served {
            screen::note(&format!("debugger: {error}"));
        }
        if is_once {
            return Ok(Exit::Success);
        }
    }
}

/// Creates a debugger for a client's launch request: programs, and the options of a board by their long names. Options
/// of the command line apply unless the client sets them.
fn launch(arguments: &DebugArguments, request: &Launch) -> Result<Debugger<AnyTarget>, String> {
    let line = request.command_line().map_err(|error| error.to_string())?;
    let words = canonical_words([&arguments.words, line.as_slice()].concat());
    let arguments = LaunchArguments::with_sidecars(&words).map_err(|error| format!("{error:#}"))?;
    let debugger = debugger(&arguments.debug).map_err(|error| format!("{error:#}"))?;
    debugger.ok_or_else(|| "a program has errors; `cc67 check` shows them".to_owned())
}
