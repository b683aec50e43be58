//! A connected controller in an editor: its programs run even while the editor shows them as stopped.

use std::io::{self, Write};

use cc67_host::{Capability, Target};
use serde_json::Value;

use super::{MoveRequest, Server};
use crate::debugger::StepKind;

/// The message of the editor's console when programs of a controller start.
const RUNS_ON: &str =
    "The programs run on a controller: Pause stops this view, not them. Stop kills their threads.\n";

impl<W: Write, T: Target> Server<'_, W, T> {
    /// Returns whether the target runs by itself.
    fn is_connected(&self) -> bool {
        let session = self.shell.as_ref().map(|shell| shell.debugger().session());
        session.is_some_and(|session| !session.can(Capability::StopTime))
    }

    /// The movement that begins a launch: the programs of a controller are started first.
    pub(super) fn first_move(&mut self) -> io::Result<MoveRequest> {
        if self.is_connected() {
            self.wire.output("console", RUNS_ON)?;
            return Ok(MoveRequest::Again);
        }
        Ok(MoveRequest::Forward(StepKind::Continue))
    }

    /// Kills the programs that were launched on a controller, unless the client wants them to continue.
    pub(super) fn kill_launched(&mut self, arguments: &Value) -> io::Result<()> {
        if !self.is_connected() || arguments["terminateDebuggee"] == false {
            return Ok(());
        }
        let Some(shell) = &mut self.shell else { return Ok(()) };
        let debugger = shell.debugger_mut();
        let session = debugger.session();
        if session.target().loss_reason().is_some() {
            return Ok(());
        }
        let threads = session.programs().iter().map(|program| program.thread);
        let active: Vec<_> = threads.filter(|thread| session.thread(*thread).is_active()).collect();
        for thread in active {
            debugger.stop_thread(thread);
            self.wire.output("console", &format!("thread {thread} of the controller was killed\n"))?;
        }
        Ok(())
    }
}
