//! The programs of the board: the compiler's messages since they were saved, and the programs that wait to be loaded.

use std::collections::BTreeMap;
use std::sync::Arc;

use cc67_host::{CompileMessage, Options, UserProgram};
use kmotiondef::ThreadId;
use serde_json::{Value, json};

use super::machine::MachineState;
use super::saved::{self, Watch};
use crate::hub::{CompileResult, Hub};
use crate::{Program, Show};

/// The programs.
#[derive(Debug)]
pub(super) struct Programs {
    programs: Vec<Program>,
    options: Options,
    /// True if a saved program is loaded at once.
    reloads: bool,
    /// The programs that were saved without errors and are not loaded yet.
    waiting: BTreeMap<ThreadId, UserProgram>,
    /// The programs that were loaded in place of the first ones.
    loaded: BTreeMap<ThreadId, UserProgram>,
    /// The errors of programs that were saved with errors.
    wrong: BTreeMap<ThreadId, Vec<CompileMessage>>,
    /// The state of the machine file since the board was created.
    pub(super) machine: MachineState,
    /// The text of the machine file from which the board was created.
    pub(super) machine_text: Option<Vec<u8>>,
    /// Keeps the watch on their files alive.
    pub(super) watch: Watch,
}

impl Programs {
    /// The programs of a board, whose files are watched from now on.
    pub(super) fn watched(show: &Show, options: &Options, hub: &Arc<Hub>) -> Self {
        let watch = Watch::default();
        saved::watch(show.programs.clone(), show.include_dirs.clone(), options.clone(), (&watch, hub));
        Self {
            watch,
            machine: MachineState::default(),
            machine_text: None,
            programs: show.programs.clone(),
            options: options.clone(),
            reloads: show.reloads,
            waiting: show.programs.iter().filter_map(waiting).collect(),
            loaded: BTreeMap::new(),
            wrong: BTreeMap::new(),
        }
    }

    /// Notes that a program was saved; returns the programs to be loaded now, if that is allowed.
    pub(super) fn saved(&mut self, compiled: CompileResult, may_load: bool) -> Vec<UserProgram> {
        self.note(compiled);
        if self.reloads && may_load { self.take() } else { Vec::new() }
    }

    /// Returns the programs to be loaded: those that wait, or all programs again if none does.
    pub(super) fn reload(&mut self) -> Vec<UserProgram> {
        if self.waiting.is_empty() {
            for program in self.programs.clone() {
                self.note(saved::compile(&program, &self.options));
            }
        }
        self.take()
    }

    fn take(&mut self) -> Vec<UserProgram> {
        let programs: Vec<_> = std::mem::take(&mut self.waiting).into_values().collect();
        programs.iter().for_each(|program| drop(self.loaded.insert(program.thread, program.clone())));
        programs
    }

    /// The programs that were loaded since power-up, for the next power-up.
    pub(super) fn loaded(&self) -> Vec<UserProgram> {
        self.loaded.values().cloned().collect()
    }

    fn note(&mut self, CompileResult { program, result }: CompileResult) {
        self.waiting.remove(&program.thread);
        self.wrong.remove(&program.thread);
        match result {
            Ok(image) => drop(self.waiting.insert(program.thread, image.started())),
            Err(messages) => drop(self.wrong.insert(program.thread, messages)),
        }
    }

    /// A message about the programs that were not loaded because of errors; `None` without any.
    pub(super) fn refusal(&self) -> Option<String> {
        let (thread, errors) = self.wrong.first_key_value()?;
        let named = self.programs.iter().find(|program| program.thread == *thread);
        let name =
            named.map_or_else(|| format!("thread {thread}"), |program| program.path.display().to_string());
        let first = errors.first().map_or("", |error| &*error.message);
        let more = if errors.len() > 1 { format!(" and {} more", errors.len() - 1) } else { String::new() };
        Some(format!("{name} is not loaded: {first}{more}; the errors are at their lines in Source"))
    }

    /// Returns the message for pages: the changed programs, and the errors of each.
    pub(super) fn message(&self) -> Value {
        let waiting: Vec<_> = self.waiting.keys().map(|thread| thread.get()).collect();
        let error = |thread: ThreadId, error: &CompileMessage| {
            json!({
                "thread": thread.get(), "file": error.file, "line": error.line, "column": error.column,
                "text": error.message, "report": error.report,
            })
        };
        let errors = self.wrong.iter();
        let errors = errors.flat_map(|(thread, errors)| errors.iter().map(|one| error(*thread, one)));
        json!({ "kind": "programs", "waiting": waiting, "errors": errors.collect::<Vec<_>>() })
    }
}

/// A program that is loaded only on request, with its thread.
fn waiting(program: &Program) -> Option<(ThreadId, UserProgram)> {
    program.waiting.as_deref().map(|compiled| (program.thread, compiled.clone()))
}
