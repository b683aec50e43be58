//! Several boards of one server, each with its machine, in a separate thread.

use std::path::PathBuf;
use std::sync::mpsc::channel;
use std::thread;

use anyhow::{Context, Result, anyhow, ensure};

use super::message::location;
use super::{BoardWork, ServeArguments, ServeTerms, ServerStart, end_all};
use crate::cli::io::exit::Exit;
use crate::cli::io::{stack, terminal};
use crate::cli::session::Setup;

/// One of several boards: its name, and its machine file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BoardFile {
    name: String,
    machine: PathBuf,
}

impl BoardFile {
    /// Parses `NAME=MACHINE.toml`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((name, file)) if !name.is_empty() && !file.is_empty() => {
                Ok(Self { name: name.to_owned(), machine: file.into() })
            }
            _ => Err("expected NAME=MACHINE.toml".to_owned()),
        }
    }

    /// The setup of the arguments with this machine.
    fn setup(&self, arguments: &ServeArguments) -> Result<Option<Setup>> {
        let mut board = arguments.board.clone();
        board.machine = Some(self.machine.clone());
        Setup::new(&arguments.programs, &board, &arguments.compiler)
            .with_context(|| format!("board {}", self.name))
    }
}

/// Serves the boards of the arguments until they are ended.
pub(super) fn serve(terms: &ServeTerms<'_>, arguments: &ServeArguments) -> Result<Exit> {
    refuse_for_several(terms, arguments)?;
    let boards = &arguments.serves;
    let mut works = Vec::new();
    let mut dispatchers = Vec::new();
    for (index, board) in boards.iter().enumerate() {
        ensure!(
            boards.iter().skip(index + 1).all(|other| other.name != board.name),
            "two boards are called {}",
            board.name
        );
        let Some(setup) = board.setup(arguments)? else { return Ok(Exit::Failure) };
        let (notes, inbox) = channel();
        dispatchers.push(notes);
        works.push((board, setup, inbox));
    }
    let opening = ServerStart::new(terms, dispatchers)?;
    let opening = &opening;
    thread::scope(|scope| {
        let mut threads = Vec::new();
        for (index, (board, setup, inbox)) in works.into_iter().enumerate() {
            terminal::note(&format!("board {} is at location {}", board.name, location(index)));
            let name = Some(&*board.name);
            let work = move || {
                let ended = setup.on_its_target(BoardWork { opening, inbox, index, name });
                if ended.is_err() {
                    end_all(&opening.dispatchers);
                }
                ended
            };
            let started = thread::Builder::new().stack_size(stack::NEEDED).spawn_scoped(scope, work);
            threads.push(
                started
                    .inspect_err(|_| end_all(&opening.dispatchers))
                    .context("there is no thread for a board")?,
            );
        }
        let mut exit = Exit::Success;
        for thread in threads {
            let ended = thread.join().map_err(|_| anyhow!("a board has failed"))??;
            if exit == Exit::Success {
                exit = ended;
            }
        }
        Ok(exit)
    })
}

/// Rejects options that apply to a single board.
fn refuse_for_several(terms: &ServeTerms<'_>, arguments: &ServeArguments) -> Result<()> {
    let has_page = {
        #[cfg(feature = "live")]
        {
            terms.page.is_some()
        }
        #[cfg(not(feature = "live"))]
        {
            false
        }
    };
    let options = [
        ("--machine", arguments.board.machine.is_some()),
        ("--live", has_page),
        ("--debug", arguments.attach.debug.is_some()),
        (
            "--uart and --uart-output",
            arguments.board.uart.uart.is_some() || arguments.board.uart.uart_output.is_some(),
        ),
        ("--log", terms.log.is_some()),
        ("--flash", arguments.board.pc.has_flash()),
        ("--trace and --plot", !terms.trace.is_unwritten()),
        ("--listen pty and tcp-raw", terms.is_on_wire()),
    ];
    for (option, is_given) in options {
        ensure!(!is_given, "`{option}` is of one board: it does not work with several");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_has_a_name_and_a_machine() {
        let mill = BoardFile { name: "mill".to_owned(), machine: "a=b.toml".into() };
        assert_eq!(BoardFile::parse("mill=a=b.toml"), Ok(mill));
        assert!(BoardFile::parse("=a.toml").is_err());
        assert!(BoardFile::parse("mill").is_err());
    }
}
