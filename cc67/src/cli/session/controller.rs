//! Connected controllers: the confirmation before the first use, the connection, the firmware for which programs are
//! linked.

use std::fs;
use std::io::{self, BufRead, IsTerminal};
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use cc67_controller::{Address, ControllerLink, FIRST_TIME, Progress};
use cc67_host::{EventSink, Session, Target};
use compiler::firmware::Firmware;
use kmotiondef::ThreadId;

use crate::cli::args::compiler::CompilerArguments;
use crate::cli::io::{state, terminal};

/// Connects to the controller at an address, after the user has agreed.
pub(crate) fn connect(address: &Address, is_agreed: bool) -> Result<ControllerLink> {
    agree_unless(is_agreed)?;
    let connection = ControllerLink::open(address)?;
    terminal::note(&format!("connected to {}: {}", connection.place(), connection.version().trim_end()));
    Ok(connection)
}

/// Asks for agreement, unless it was given in advance.
pub(crate) fn agree_unless(is_given: bool) -> Result<()> {
    if is_given { Ok(()) } else { require_agreement() }
}

/// Asks for agreement once for each project folder.
fn require_agreement() -> Result<()> {
    let folder = std::env::current_dir().context("cannot find the present folder")?;
    let folder = folder.display().to_string();
    let record = record();
    let agreed = record.as_ref().and_then(|path| fs::read_to_string(path).ok()).unwrap_or_default();
    if agreed.lines().any(|line| line == folder) {
        return Ok(());
    }
    terminal::print_separated(FIRST_TIME);
    if !ask_user("Connect?")? {
        bail!("not connected");
    }
    let Some(path) = record else { return Ok(()) };
    let kept = path.parent().map_or(Ok(()), fs::create_dir_all);
    // Without this file the question is asked again, which does no harm.
    if let Err(error) = kept.and_then(|()| fs::write(&path, format!("{agreed}{folder}\n"))) {
        terminal::note(&format!("the answer cannot be kept in {}: {error}", path.display()));
    }
    Ok(())
}

/// Asks the user at the terminal a question; without a terminal, it counts as declined.
pub(crate) fn ask_user(question: &str) -> Result<bool> {
    if !(io::stdin().is_terminal() && io::stderr().is_terminal()) {
        bail!("nobody is here to agree to that: `--yes` does");
    }
    agrees_to(question)
}

/// Asks the user at the terminal a question; returns whether the answer is yes.
fn agrees_to(question: &str) -> Result<bool> {
    terminal::print_separated(&format!("{question} [y/N] "));
    let mut answer = String::new();
    io::stdin().lock().read_line(&mut answer).context("cannot read the answer")?;
    Ok(matches!(answer.trim(), "y" | "Y" | "yes"))
}

/// The file with the project folders for which the user has agreed.
fn record() -> Option<PathBuf> {
    Some(state::folder()?.join("controllers"))
}

/// Returns the firmware against which programs for a controller are linked: the one in the options, or otherwise the
/// controller's own.
pub(crate) fn firmware(
    connection: &ControllerLink,
    named: Firmware,
    compiler: &CompilerArguments,
) -> Result<Firmware> {
    if compiler.names_firmware() {
        return Ok(named);
    }
    let Some(board) = connection.board() else {
        bail!(
            "{}: its firmware `{}` is not known; `--firmware FILE` names the file of that firmware",
            connection.place(),
            connection.version().trim_end()
        );
    };
    Ok(if board.is_default() { Firmware::default() } else { Firmware::Board(board) })
}

/// Returns a function that reports the progress of downloads.
pub(crate) fn progress() -> impl FnMut(ThreadId, Progress) + Send + 'static {
    |thread, Progress { done, total }| {
        let is_shown = io::stderr().is_terminal();
        if is_shown && total > 0 {
            terminal::print_separated(&format!("\rthread {thread}: {done} of {total} bytes loaded"));
            if done == total {
                terminal::print_separated("\r\x1b[K");
            }
        }
    }
}

/// Stops the programs of a session after Ctrl-C, and offers to disable the axes.
pub(crate) fn stop<T: Target>(session: &mut Session<T>, events: EventSink<'_>) {
    let programs: Vec<ThreadId> = session.debug().into_iter().map(|(thread, _)| thread).collect();
    let active: Vec<_> = programs.into_iter().filter(|thread| session.thread(*thread).is_active()).collect();
    active.iter().for_each(|thread| session.stop(*thread));
    let stopped = active.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let left: Vec<_> = active.iter().filter(|thread| session.thread(**thread).is_active()).collect();
    match (active.is_empty(), left.is_empty()) {
        (true, _) => {}
        (false, true) => terminal::note(&format!("thread {stopped} stopped; enabled axes stay enabled")),
        (false, false) => terminal::note(&format!("thread {stopped} may still run: use the emergency stop")),
    }
    if session.target().loss_reason().is_some() || !io::stdin().is_terminal() {
        return;
    }
    // An answer that cannot be read counts as "no".
    if agrees_to("Disable all axes?").unwrap_or(false) {
        for axis in session.target().axes().iter() {
            session.exchange(format!("DisableAxis{axis}").as_bytes(), events);
        }
    }
}
