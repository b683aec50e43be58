//! Actions of a person at the machine.

use vm::memory::GuestMemory;

use crate::world::WorldAccess;
use crate::world::stimulus::action::{self, Action};
use crate::world::stimulus::reader::StatementReader;
use crate::world::stimulus::scene::Scene;
use crate::world::stimulus::tokens::Mistake;

/// An action of a person: the model executes it; with a connected controller the user is told to do it.
#[derive(Clone, Debug, PartialEq)]
pub struct ManualStep {
    /// The request to the person, such as "press START".
    pub text: String,
    /// The effect on the machine.
    pub action: Box<Action>,
}

/// `manual "TEXT" ACTION`
pub(crate) fn read_manual(reader: &mut StatementReader<'_>) -> Result<(ManualStep,), Mistake> {
    let text = reader.string()?;
    let column = reader.column();
    let action = action::read(reader)?;
    match action {
        Action::Expect(_) | Action::Manual(_) | Action::Run(..) | Action::Attach(_) => Err((
            column,
            "a person does nothing here: after `manual \"…\"` comes the effect, as in `pulse bit 136`"
                .to_owned(),
        )),
        action => Ok((ManualStep { text, action: Box::new(action) },)),
    }
}

pub(crate) fn act(scene: &mut Scene<'_, '_, '_>, step: ManualStep) {
    step.action.act(scene);
}

pub(crate) fn announce(step: &ManualStep, access: &mut WorldAccess<'_>, memory: &mut GuestMemory) {
    step.action.announce(access, memory);
}
