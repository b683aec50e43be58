//! The programs of the board: what the compiler says of them since they were saved, and which wait to be loaded.

use std::collections::BTreeMap;
use std::sync::Arc;

use cc67_host::{Options, UserProgram};
use kmotiondef::ThreadId;
use serde_json::{Value, json};

use super::saved;
use crate::desk::{Compiled, Desk};
use crate::{Program, Show};

/// The programs.
#[derive(Debug)]
pub(super) struct Programs {
    programs: Vec<Program>,
    options: Options,
    /// Whether one that is saved is loaded at once.
    reloads: bool,
    /// Those that were saved without errors and are not loaded yet.
    waiting: BTreeMap<ThreadId, UserProgram>,
    /// Those that were loaded in place of the first ones.
    loaded: BTreeMap<ThreadId, UserProgram>,
    /// What is wrong with those that were saved with errors: lines of `file:line: message`.
    wrong: BTreeMap<ThreadId, String>,
}

impl Programs {
    /// The programs of a board, whose files are looked at from now on.
    pub(super) fn watched(show: &Show, options: &Options, desk: &Arc<Desk>) -> Self {
        saved::watch(show.programs.clone(), show.include_dirs.clone(), options.clone(), desk);
        Self {
            programs: show.programs.clone(),
            options: options.clone(),
            reloads: show.reloads,
            waiting: show.programs.iter().filter_map(waiting).collect(),
            loaded: BTreeMap::new(),
            wrong: BTreeMap::new(),
        }
    }

    /// A program was saved; what should be loaded now, if it may be.
    pub(super) fn saved(&mut self, compiled: Compiled, may_load: bool) -> Vec<UserProgram> {
        self.note(compiled);
        if self.reloads && may_load { self.take() } else { Vec::new() }
    }

    /// What should be loaded: what waits; where nothing does, every program again.
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

    /// Those that were loaded since the board was switched on, for the next time that it is.
    pub(super) fn loaded(&self) -> Vec<UserProgram> {
        self.loaded.values().cloned().collect()
    }

    fn note(&mut self, Compiled { program, result }: Compiled) {
        self.waiting.remove(&program.thread);
        self.wrong.remove(&program.thread);
        match result {
            Ok(image) => drop(self.waiting.insert(program.thread, image.started())),
            Err(text) => drop(self.wrong.insert(program.thread, text)),
        }
    }

    /// What pages are told: which programs have changed, and what is wrong with which.
    pub(super) fn message(&self) -> Value {
        let waiting: Vec<_> = self.waiting.keys().map(|thread| thread.get()).collect();
        let errors = self.wrong.iter().flat_map(|(thread, text)| {
            text.lines().map(|line| {
                let (file, number, message) = place(line);
                json!({ "thread": thread.get(), "file": file, "line": number, "text": message })
            })
        });
        json!({ "kind": "programs", "waiting": waiting, "errors": errors.collect::<Vec<_>>() })
    }
}

/// A program that is loaded when a page asks for it, with its thread.
fn waiting(program: &Program) -> Option<(ThreadId, UserProgram)> {
    program.waiting.as_deref().map(|compiled| (program.thread, compiled.clone()))
}

/// The parts of `file:line: message`; a drive letter is not a file.
fn place(line: &str) -> (Option<&str>, Option<u32>, &str) {
    for (at, _) in line.match_indices(':').filter(|(at, _)| *at > 1) {
        let (file, rest) = (line.get(..at), line.get(at + 1..).unwrap_or_default());
        let Some((number, message)) = rest.split_once(':') else { continue };
        if let Ok(number) = number.parse() {
            return (file, Some(number), message.trim());
        }
    }
    (None, None, line)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_is_split_off_a_compiler_message() {
        assert_eq!(place("a.c:12: error: no"), (Some("a.c"), Some(12), "error: no"));
        assert_eq!(place("C:\\x\\a.c:3: e"), (Some("C:\\x\\a.c"), Some(3), "e"));
        assert_eq!(place("cannot be linked: x"), (None, None, "cannot be linked: x"));
    }
}
