//! The machine file of a shown board: after it is saved, it is applied when the board restarts.

use std::fs;

use cc67_host::{Session, Target};
use serde_json::{Value, json};

use super::log::EntrySource;
use super::{ViewState, saved};
use crate::hub::Hub;

/// The state of the machine file since the board was created from it.
#[derive(Debug, Default)]
pub(super) enum MachineState {
    /// It is unchanged.
    #[default]
    Same,
    /// It was saved.
    Saved,
    /// It was saved with an error.
    Wrong(String),
    /// It was saved, and a page has requested a board made from it.
    Wanted,
}

impl<T: Target> ViewState<T> {
    /// Watches the machine file from now on.
    pub(super) fn watch_machine(&mut self, hub: &std::sync::Arc<Hub>) {
        if let Some(path) = &self.show.machine.path {
            self.programs.machine_text = fs::read(path).ok();
            saved::watch_machine(path.clone(), &self.programs.watch, hub);
        }
    }

    /// Returns whether the machine file still has the text from which the board was created.
    fn is_as_made(&self) -> bool {
        let text = self.show.machine.path.as_ref().and_then(|path| fs::read(path).ok());
        text.is_some() && text == self.programs.machine_text
    }

    /// Notes that the machine file was saved.
    pub(super) fn machine_saved(&mut self, session: &Session<T>, checked: Result<(), String>) {
        self.programs.machine = match checked {
            _ if self.is_as_made() => MachineState::Same,
            Ok(()) => MachineState::Saved,
            Err(text) => MachineState::Wrong(text),
        };
        if let Some(text) = self.machine_text() {
            self.log.add_message(session.tick(), EntrySource::Remark, text);
        }
        self.broadcast(&self.machine());
    }

    /// The state of the machine file, as a message to pages.
    pub(super) fn machine(&self) -> Value {
        let is_wrong = matches!(self.programs.machine, MachineState::Wrong(_));
        json!({ "kind": "machine", "text": self.machine_text(), "wrong": is_wrong })
    }

    fn machine_text(&self) -> Option<String> {
        let name = self.show.machine.path.as_ref()?.display();
        match &self.programs.machine {
            MachineState::Same | MachineState::Wanted => None,
            MachineState::Saved if self.show.machine.can_rebuild => {
                Some(format!("{name} is saved: Restart applies it"))
            }
            MachineState::Saved => {
                Some(format!("{name} is saved: this board keeps the old one until cc67 is started again"))
            }
            MachineState::Wrong(text) => Some(format!("{text}; this board keeps the machine that it has")),
        }
    }

    /// Requests a restart with the saved machine file; returns false if the file is unchanged and a normal restart is
    /// meant.
    pub(super) fn wants_new_machine(&mut self) -> Result<bool, String> {
        match &self.programs.machine {
            MachineState::Wrong(text) => Err(text.clone()),
            MachineState::Saved if self.show.machine.can_rebuild => {
                self.programs.machine = MachineState::Wanted;
                Ok(true)
            }
            MachineState::Same | MachineState::Saved | MachineState::Wanted => Ok(false),
        }
    }

    /// Returns whether a page has requested a board made from the saved machine file.
    pub(super) const fn is_rebuild_wanted(&self) -> bool {
        matches!(self.programs.machine, MachineState::Wanted)
    }

    /// Reports that no board can be made from that machine file.
    pub(super) fn refuse_rebuild(&mut self, text: &str) {
        self.programs.machine = MachineState::Wrong(text.to_owned());
        self.broadcast(&self.machine());
        self.broadcast(&json!({ "kind": "problem", "text": text }));
    }
}
