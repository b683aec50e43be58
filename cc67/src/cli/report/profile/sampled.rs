//! The profile of a run on the user's own firmware file: samples of the processor, each of which represents some
//! cycles.
//!
//! Code of a program has its lines; code of the firmware has the names from the file. A firmware function that waits
//! polls for the end of the wait, so its time counts as computing.

use anyhow::Result;
use boot::ProcessorState;
use cc67_host::{BootedTarget, Session, Target as _, UserProgram};
use kmotiondef::{CodeAddr, ThreadId};
use runtime::debug::DebugInfo;
use vm::engine::ContextId;

use super::{Account, ProfileFrame, ProfileOutput, ProfilePlace, TimeConsumer, finish};

/// The sampled board: the programs, and the firmware.
pub(crate) struct SampledBoard<'a> {
    target: &'a BootedTarget,
    /// Debug information of the programs in the threads.
    known: Vec<DebugInfo>,
}

impl<'a> SampledBoard<'a> {
    /// The samples of a session.
    pub(crate) fn of(session: &'a Session<BootedTarget>) -> Self {
        let known = session.programs().iter().map(UserProgram::debug_info).collect();
        Self { target: session.target(), known }
    }

    /// Writes the flame graph if requested, and returns the table.
    pub(crate) fn report(&self, output: &ProfileOutput) -> Result<String> {
        let mut account = Account::new();
        for (state, time) in self.target.sampled() {
            account.entry(self.place(state)).or_default().computing += time;
        }
        finish(&account, self.target.now(), output)
    }

    fn place(&self, state: &ProcessorState) -> ProfilePlace {
        let address = CodeAddr::new(state.pc);
        let source = address.and_then(|address| self.known.iter().find_map(|names| names.place(address)));
        let thread = state.thread.and_then(|thread| i32::try_from(thread).ok()).and_then(ThreadId::new);
        let whose = match (state.is_masked, &source, thread) {
            (true, Some(_), _) => TimeConsumer::Program(ContextId::CALLBACK),
            (true, None, _) => TimeConsumer::Interrupt,
            (false, _, Some(thread)) => TimeConsumer::Program(ContextId::of(thread)),
            (false, _, None) => TimeConsumer::Firmware,
        };
        let frame = source.as_ref().map(|place| ProfileFrame {
            function: place.function.to_owned(),
            file: place.file.to_owned(),
            line: place.line,
        });
        let unknown = || format!("0x{:08X}", state.pc);
        let firmware = frame
            .is_none()
            .then(|| self.target.file().function_at(state.pc).map_or_else(unknown, |(name, _)| name));
        ProfilePlace { whose, frames: frame.into_iter().collect(), firmware }
    }
}
