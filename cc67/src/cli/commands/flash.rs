//! `cc67 flash`: the state with which a controller starts at its next power-up.

use std::ffi::OsString;
use std::fmt::Write as _;

use anyhow::{Result, bail, ensure};
use cc67_controller::{Address, ControllerLink};
use cc67_host::UserProgram;
use clap::Args;
use compiler::Options;
use compiler::firmware::FirmwareNames;
use compiler::target::Target as CodeTarget;
use kmotiondef::ThreadId;

use crate::cli::args::compiler::CompilerArguments;
use crate::cli::args::{heading, program};
use crate::cli::compile::images;
use crate::cli::io::exit::Exit;
use crate::cli::io::terminal;
use crate::cli::session::controller;

/// Arguments of `cc67 flash`.
#[derive(Debug, Args)]
pub(super) struct FlashArguments {
    /// Sources or images that are loaded, but not started, before saving: FILE goes to the lowest free thread, N:FILE to thread N
    #[arg(value_name = "[N:]FILE")]
    programs: Vec<OsString>,
    /// Threads that start by themselves at power-up, such as 1,3, or `none` [default: unchanged]
    #[arg(long, value_name = "THREADS", value_parser = Startup::parse)]
    startup: Option<Startup>,
    /// The controller: usb[:LOCATION], serial:PATH, server[:PATH|:HOST:PORT], kogna[:SERIAL], tcp:HOST:PORT; `cc67 boards` lists what is
    /// connected
    #[arg(long, value_name = "BOARD", required = true, help_heading = heading::CONTROLLER)]
    on: Option<Address>,
    /// Load programs even if they were linked for a different firmware; their calls may then jump
    /// anywhere
    #[arg(long, help_heading = heading::CONTROLLER)]
    force: bool,
    /// Connect and write without asking; for scripts
    #[arg(long, help_heading = heading::CONTROLLER)]
    yes: bool,
    #[command(flatten)]
    compiler: CompilerArguments,
}

/// The threads that start automatically.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Startup(Vec<ThreadId>);

impl Startup {
    fn parse(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self(Vec::new()));
        }
        let thread = |word: &str| word.trim().parse().ok().and_then(ThreadId::new);
        let threads: Option<Vec<_>> = text.split(',').map(thread).collect();
        threads
            .map(Self)
            .ok_or_else(|| format!("threads are numbers from 1 to {}, such as 1,3", ThreadId::MAX))
    }
}

/// Loads programs and saves the controller's memory to its flash.
pub(super) fn flash(arguments: &FlashArguments) -> Result<Exit> {
    let Some(address) = &arguments.on else { bail!("`--on` names the controller") };
    let mut connection = controller::connect(address, arguments.yes)?;
    let compiler = &arguments.compiler;
    let options = compiler.resolve()?;
    let firmware = controller::firmware(&connection, options.firmware.clone(), compiler)?;
    let linked_for = firmware.version().unwrap_or(FirmwareNames::board(&firmware).version).to_owned();
    let options = Options { target: CodeTarget::C67x, firmware, ..options };
    let files = program::assign(&arguments.programs)?;
    let Some(programs) = images::programs(&files, compiler, &options)? else { return Ok(Exit::Failure) };
    require_rest(&mut connection, address)?;
    terminal::print_separated(&arguments.plan(&connection, &programs));
    if !arguments.yes && !controller::ask_user("Write flash?")? {
        terminal::note("nothing was changed");
        return Ok(Exit::Failure);
    }
    let mut progress = controller::progress();
    for program in &programs {
        let progress = &mut |piece| progress(program.thread, piece);
        connection.load(program, &linked_for, arguments.force, progress)?;
    }
    connection.save(arguments.startup.as_ref().map(|startup| &*startup.0))?;
    terminal::note(
        "flash is written, and the controller has compared it with its memory; it counts from the next power-up",
    );
    Ok(Exit::Success)
}

/// Refuses to save while something is in motion.
fn require_rest(connection: &mut ControllerLink, address: &Address) -> Result<()> {
    let unsettled = connection.unsettled()?;
    let mut reasons = Vec::new();
    let names = |numbers: Vec<String>| numbers.join(", ");
    if !unsettled.threads.is_empty() {
        let threads = unsettled.threads.iter().map(ToString::to_string).collect();
        reasons.push(format!("active threads ({}) are saved in the middle of their work", names(threads)));
    }
    if !unsettled.axes.is_empty() {
        let axes = unsettled.axes.iter().map(ToString::to_string).collect();
        reasons.push(format!("enabled axes ({}) are enabled at power-up", names(axes)));
    }
    ensure!(
        unsettled.is_empty(),
        "flash is not written: {}; end that first: `cc67 console --on {address}`, then {}",
        reasons.join(", "),
        unsettled.commands().join(", ")
    );
    Ok(())
}

impl FlashArguments {
    /// Describes the data that will be written.
    fn plan(&self, connection: &ControllerLink, programs: &[UserProgram]) -> String {
        let mut text = format!(
            "\nThis writes the flash of {}. From its next power-up on the controller has\n\n",
            connection.place()
        );
        for program in programs {
            let _ = writeln!(text, "  thread {}    {}, loaded now", program.thread, program.name());
        }
        let others = if programs.is_empty() { "all threads" } else { "others" };
        let _ = writeln!(text, "  {others:<11} the programs that they hold now");
        let threads = self.startup.as_ref().map(|Startup(threads)| threads.iter().map(ToString::to_string));
        let startup = match threads.map(|threads| threads.collect::<Vec<_>>().join(", ")) {
            None => "as it is now".to_owned(),
            Some(threads) if threads.is_empty() => "no thread".to_owned(),
            Some(threads) => format!("thread {threads}"),
        };
        let _ = writeln!(text, "  starting    {startup}");
        text.push_str(
            "  settings    axes, persist and coordinate system as they are now\n\n\
             What flash holds now and the gather buffer are lost; the firmware stays. It takes about 7 s: keep the\n\
             power on.\n",
        );
        text
    }
}
