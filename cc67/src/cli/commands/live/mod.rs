//! `cc67 live`: a simulated board on a page in the browser.
//!
//! The page itself is implemented in `cc67-live`; this module provides the board, and opens a browser.

mod demo;
mod kept;

use std::ffi::{OsStr, OsString};
use std::io::{self, Write};
use std::net::Ipv4Addr;
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use cc67_host::{Target, UserProgram};
use cc67_live::{
    BoardUsers, ListenError, Program, Server, Show, ShowEnd, ShownMachine, TestOption, TimeControl,
};
use clap::{Arg, Args, Parser};

use crate::cli::args::attach::AttachArguments;
use crate::cli::args::board::BoardArguments;
use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::program::assign;
use crate::cli::args::sidecars::SidecarArguments;
use crate::cli::args::time::seconds;
use crate::cli::args::uart::UartArguments;
use crate::cli::io::exit::Exit;
use crate::cli::io::terminal;
use crate::cli::session::{BoardSession, Setup, StartPlan, Work};
use kept::KeptAccess;

/// The default port, if it is free.
const PORT: u16 = 8067;

/// Arguments of `cc67 live`.
#[derive(Debug, Args)]
#[command(mut_args(hide_serial_port))]
pub(super) struct LiveArguments {
    /// Programs to load and start: FILE runs in the lowest free thread, N:FILE in thread N
    #[arg(value_name = "[N:]FILE")]
    programs: Vec<OsString>,
    /// Listen on this port; 0 picks a free one [default: 8067, or a free one if that is taken]
    #[arg(long, value_name = "PORT")]
    port: Option<u16>,
    /// Do not open a browser
    #[arg(long)]
    no_open: bool,
    /// Signals of the scope: items such as dest0,bit46, and C expressions with the programs' names
    #[arg(long, value_name = "LIST", default_value = "", hide_default_value = true)]
    watch: String,
    /// Speed relative to real time, 0.01 to 100
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = speed)]
    speed: f64,
    /// Show a machine that homes and mills; its files are written to a new folder
    #[arg(long, conflicts_with = "programs")]
    demo: bool,
    /// Start paused
    #[arg(long)]
    paused: bool,
    /// Load a program whenever it is saved without errors
    #[arg(long)]
    reload: bool,
    /// Stop after SECONDS of board time
    #[arg(long = "for", alias = "until", value_name = "SECONDS", value_parser = seconds)]
    limit: Option<f64>,
    #[command(flatten)]
    attach: AttachArguments,
    #[command(flatten)]
    sidecars: SidecarArguments,
    #[command(flatten)]
    board: BoardArguments,
    #[command(flatten)]
    compiler: CompilerArguments,
}

impl LiveArguments {
    /// The programs, if the files next to them should be used.
    pub(super) fn with_sidecars(&self) -> Option<&[OsString]> {
        (!self.sidecars.no_sidecar).then_some(&self.programs)
    }
}

/// Hides an option of the serial port in the help: [`live`] rejects it.
fn hide_serial_port(argument: Arg) -> Arg {
    let is_hidden = argument.get_id().as_str().starts_with("uart");
    if is_hidden { argument.hide(true) } else { argument }
}

/// Parses a speed factor.
fn speed(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok().filter(|factor| (0.01..=100.0).contains(factor));
    factor.ok_or_else(|| "expected a number from 0.01 to 100".to_owned())
}

/// Shows a board until it is interrupted.
pub(super) fn live(arguments: &LiveArguments) -> Result<Exit> {
    if arguments.board.controller.on.is_some() {
        arguments.refuse_with_controller()?;
    }
    let UartArguments { uart_input, uart_output, uart } = &arguments.board.uart;
    if uart_input.is_some() || uart_output.is_some() || uart.is_some() {
        bail!("`cc67 live`: the serial port cannot be connected yet");
    }
    if arguments.demo {
        return demonstrate(arguments);
    }
    let mut server = None;
    loop {
        let Some(mut setup) = arguments.setup()? else { return Ok(Exit::Failure) };
        // Nothing is loaded into a controller before control is enabled on the page.
        let waiting = if setup.is_of_controller() { setup.take_programs() } else { Vec::new() };
        let debugger = arguments.attach.open()?;
        let mut end = ShowEnd::TimeOver;
        let page = LivePage { arguments, waiting, server: &mut server, end: &mut end };
        let exit = setup.debugged(debugger, page)?;
        if end == ShowEnd::TimeOver {
            return Ok(exit);
        }
    }
}

/// The page of a board, and the programs that wait until a user loads them.
struct LivePage<'a> {
    arguments: &'a LiveArguments,
    waiting: Vec<UserProgram>,
    /// The server, once it listens: it is kept for the next board.
    server: &'a mut Option<Server>,
    /// The reason for the end.
    end: &'a mut ShowEnd,
}

/// Shows the demonstration, with the arguments that concern the page.
fn demonstrate(arguments: &LiveArguments) -> Result<Exit> {
    let folder = demo::write()?;
    terminal::note(&format!("the files of the demonstration are in {}", folder.display()));
    let mut words = vec!["live".to_owned()];
    words.extend(demo::arguments(&folder));
    words.push(format!("--speed={}", arguments.speed));
    words.extend(arguments.port.map(|port| format!("--port={port}")));
    words.extend(arguments.limit.map(|limit| format!("--for={limit}")));
    let switches =
        [("--no-open", arguments.no_open), ("--paused", arguments.paused), ("--reload", arguments.reload)];
    words.extend(switches.iter().filter(|(_, is_on)| *is_on).map(|(word, _)| (*word).to_owned()));
    live(&Demonstration::try_parse_from(words)?.arguments)
}

/// The arguments of the demonstration, as if they had been typed.
#[derive(Debug, Parser)]
struct Demonstration {
    #[command(flatten)]
    arguments: LiveArguments,
}

impl Work for LivePage<'_> {
    fn on<T: Target>(self, mut board: BoardSession<T>) -> Result<Exit> {
        let Self { arguments, waiting, server, end } = self;
        let mut show = arguments.show()?;
        // An attached editor cannot be switched to another board.
        show.machine.can_rebuild =
            arguments.attach.debug.is_none() && arguments.board.controller.on.is_none();
        for compiled in waiting {
            let shown = show.programs.iter_mut().find(|program| program.thread == compiled.thread);
            if let Some(shown) = shown {
                shown.waiting = Some(Box::new(compiled));
            }
        }
        let server = match server {
            Some(server) => {
                show.is_paused = false;
                server
            }
            None => {
                let listening = listen(arguments.port, &arguments.board)?;
                announce(&listening, &arguments.board, !arguments.no_open)?;
                server.insert(listening)
            }
        };
        let keeper = Box::new(board.flash_keeper());
        let company = BoardUsers { attendant: board.attendant.take(), keeper: Some(keeper) };
        let mut check = || match arguments.setup() {
            Ok(Some(_)) => Ok(()),
            Ok(None) => Err("the board is not made again: a program has errors".to_owned()),
            Err(error) => Err(format!("the board is not made again: {error:#}")),
        };
        *end = server.run(&mut board.session, show, company, &mut check);
        board.finish(&mut |_| ())?;
        Ok(Exit::Success)
    }
}

/// Collects the contents of a page that are not the board's state: the programs, and the connected equipment.
pub(super) fn show(
    programs: &[OsString],
    board: &BoardArguments,
    compiler: &CompilerArguments,
) -> Result<Show> {
    let files = assign(&[programs, &board.load].concat())?;
    let options = compiler.resolve()?;
    let shown = files.into_iter().map(|file| Program {
        thread: file.thread,
        is_image: file.is_image(),
        path: file.path,
        waiting: None,
    });
    Ok(Show {
        title: programs.join(OsStr::new(", ")).to_string_lossy().into_owned(),
        machine: ShownMachine {
            file: board.machine_file(options.firmware.board())?,
            path: board.machine.clone(),
            can_rebuild: false,
        },
        programs: shown.collect(),
        include_dirs: options.preprocessor.include_dirs,
        watch: String::new(),
        speed: 1.0,
        is_paused: false,
        reloads: false,
        time: if board.controller.on.is_some() { TimeControl::Real } else { TimeControl::Full },
        limit: None,
        command: std::env::current_exe().context("cannot find the file of this command")?,
        test_options: Vec::new(),
    })
}

/// Listens for pages: on the requested port, or otherwise on the port of the last run in this folder, the default port,
/// or a free port. Pages of the last run may reconnect, unless other computers can listen to the connection.
pub(super) fn listen(port: Option<u16>, board: &BoardArguments) -> Result<Server> {
    let host = board.pc.address().unwrap_or(Ipv4Addr::LOCALHOST.into());
    let kept = if host.is_loopback() { kept::read() } else { None };
    let token = kept.as_ref().map(|kept| &*kept.token);
    let mut ports = match port {
        Some(port) => vec![port],
        None => kept.as_ref().map(|kept| kept.port).into_iter().chain([PORT, 0]).collect(),
    }
    .into_iter();
    let server = loop {
        match (Server::listen(host, ports.next().unwrap_or_default(), token), ports.len()) {
            (Err(ListenError::Address { .. }), 1..) => {}
            (listening, _) => break listening?,
        }
    };
    if host.is_loopback() {
        kept::write(&KeptAccess { token: server.token().to_owned(), port: server.port() });
    }
    Ok(server)
}

/// Prints the URL of the page, and opens it.
pub(super) fn announce(server: &Server, board: &BoardArguments, opens: bool) -> Result<()> {
    if board.pc.address().is_some_and(|host| !host.is_loopback()) {
        terminal::note("other computers can reach this page: anyone with the address can move the machine");
    }
    let mut out = io::stdout();
    writeln!(out, "{}", server.url()).and_then(|()| out.flush()).context("cannot write the address")?;
    if opens {
        open(server.url());
    }
    Ok(())
}

impl LiveArguments {
    /// Rejects options that do not work with a controller.
    fn refuse_with_controller(&self) -> Result<()> {
        ensure!(!self.demo, "`--demo` is a simulated machine: it does not work with `--on`");
        ensure!(!self.paused, "`--paused`: the time of a connected controller cannot be stopped");
        ensure!(self.speed == 1.0, "`--speed`: the time of a connected controller passes by itself");
        ensure!(
            self.attach.debug.is_none(),
            "`--debug`: programs on a connected controller cannot be stopped"
        );
        ensure!(
            self.sidecars.first.is_empty(),
            "`--first` is about a simulated board: it does not work with `--on`"
        );
        Ok(())
    }

    /// Reads and compiles the inputs for the board; `None` if a program has errors, which have been reported.
    fn setup(&self) -> Result<Option<Setup>> {
        let started = StartPlan { programs: &self.programs, first: &self.sidecars.first };
        Setup::new(started, &self.board, &self.compiler)
    }

    /// Returns the options of the page.
    fn show(&self) -> Result<Show> {
        Ok(Show {
            watch: self.watch.clone(),
            speed: self.speed,
            is_paused: self.paused,
            reloads: self.reload,
            limit: self.limit,
            test_options: self.test_options(),
            ..show(&self.programs, &self.board, &self.compiler)?
        })
    }

    /// Returns the options with which `cc67 run` creates the same board.
    fn test_options(&self) -> Vec<TestOption> {
        let text = |option: &str, value: &str| TestOption::Text(format!("{option}={value}"));
        let board = &self.board;
        let machine = board.machine.iter().map(|file| TestOption::File("--machine", file.clone()));
        let settings = board.set.iter().map(|setting| text("--set", setting));
        let stimuli = board.stim.iter().map(|stimulus| match Path::new(stimulus).exists() {
            true => TestOption::File("--stim", stimulus.into()),
            false => text("--stim", stimulus),
        });
        let answers = board.pc.single_answers().iter().map(|answer| text("--answer", answer));
        let assist = board.assist.then(|| TestOption::Text("--assist".to_owned()));
        let firmware = board.boot.iter().map(|file| TestOption::File("--boot", file.clone()));
        firmware.chain(machine).chain(settings).chain(stimuli).chain(answers).chain(assist).collect()
    }
}

/// Opens the user's browser; if that is not possible, a note refers to the URL in the terminal.
fn open(url: &str) {
    let (program, arguments): (_, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("rundll32", &["url.dll,FileProtocolHandler"])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(arguments).arg(url).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    if command.spawn().is_err() {
        terminal::note("no browser could be opened: open the address above");
    }
}
