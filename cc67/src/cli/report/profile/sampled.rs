//! The profile of a run on the user's own firmware file: looks at the processor, each of which stands for some cycles.
//!
//! Code of a program has its lines; code of the firmware has the names of the file. A firmware function that waits looks
//! again and again whether it may continue, so that its time is computing.

use anyhow::Result;
use boot::{Doing, FirmwareFile};
use cc67_host::UserProgram;
use kmotiondef::{CodeAddr, Cycles, ThreadId};
use runtime::debug::DebugInfo;
use runtime::loader::prepare;
use vm::engine::ContextId;

use super::{Account, ProfileFrame, ProfileOutput, ProfilePlace, Whose, finish};

/// What was looked at: the programs, and the firmware.
pub(crate) struct Sampled<'a> {
    /// The programs in the threads.
    pub(crate) programs: &'a [UserProgram],
    /// The firmware's names.
    pub(crate) file: &'a FirmwareFile,
    /// Board time of the run.
    pub(crate) end: Cycles,
}

impl Sampled<'_> {
    /// Writes the flame graph, if one is wanted, and gives the table.
    pub(crate) fn report<'a>(
        &self,
        looks: impl Iterator<Item = (&'a Doing, Cycles)>,
        target: &ProfileOutput,
    ) -> Result<String> {
        let known: Vec<DebugInfo> = self.programs.iter().map(program_names).collect();
        let mut account = Account::new();
        for (doing, time) in looks {
            account.entry(self.place(doing, &known)).or_default().computing += time;
        }
        finish(&account, self.end, target)
    }

    fn place(&self, doing: &Doing, known: &[DebugInfo]) -> ProfilePlace {
        let address = CodeAddr::new(doing.pc);
        let source = address.and_then(|address| known.iter().find_map(|names| names.place(address)));
        let thread = doing.thread.and_then(|thread| i32::try_from(thread).ok()).and_then(ThreadId::new);
        let whose = match (doing.is_masked, &source, thread) {
            (true, Some(_), _) => Whose::Program(ContextId::CALLBACK),
            (true, None, _) => Whose::Interrupt,
            (false, _, Some(thread)) => Whose::Program(ContextId::of(thread)),
            (false, _, None) => Whose::Firmware,
        };
        let frame = source.as_ref().map(|place| ProfileFrame {
            function: place.function.to_owned(),
            file: place.file.to_owned(),
            line: place.line,
        });
        let unknown = || format!("0x{:08X}", doing.pc);
        let firmware =
            frame.is_none().then(|| self.file.function_at(doing.pc).map_or_else(unknown, |(name, _)| name));
        ProfilePlace { whose, frames: frame.into_iter().collect(), firmware }
    }
}

/// Names and lines of a program; none of an image that the modelled board would refuse.
pub(crate) fn program_names(program: &UserProgram) -> DebugInfo {
    let prepared = prepare(&program.image, program.thread, |_| false);
    prepared.map(|prepared| prepared.debug.with_details(program.details.clone())).unwrap_or_default()
}
