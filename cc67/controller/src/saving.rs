//! Saving to flash: the state with which the controller starts at its next power-up.

use cc67_host::{HostError, UserProgram};
use cc67_wire::{Progress, Status, WireError};
use kmotiondef::{Axes, AxisId, ThreadId};

use crate::connection::ControllerLink;
use crate::controller::link;
use crate::image;

/// The state that should not be saved to flash for the next power-up.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnsettledState {
    /// Active threads: their variables would be saved in the middle of their work.
    pub threads: Vec<ThreadId>,
    /// Enabled axes: they would be saved as enabled.
    pub axes: Vec<AxisId>,
}

impl UnsettledState {
    fn of(status: &Status, axes: Axes) -> Self {
        Self {
            threads: ThreadId::all().filter(|thread| status.is_active(*thread)).collect(),
            axes: axes.iter().filter(|axis| status.is_enabled(*axis)).collect(),
        }
    }

    /// Returns whether saving is safe.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.threads.is_empty() && self.axes.is_empty()
    }

    /// Returns the script commands that settle the controller.
    #[must_use]
    pub fn commands(&self) -> Vec<String> {
        let threads = self.threads.iter().map(|thread| format!("Kill{thread}"));
        threads.chain(self.axes.iter().map(|axis| format!("DisableAxis{axis}"))).collect()
    }
}

impl ControllerLink {
    /// Returns the threads and axes that must be at rest before memory is saved.
    ///
    /// # Errors
    /// The controller does not answer.
    pub fn unsettled(&mut self) -> Result<UnsettledState, WireError> {
        let axes = self.board().map_or(Axes::default(), |board| board.axes);
        Ok(UnsettledState::of(&self.0.status()?, axes))
    }

    /// Loads a program linked for the firmware `linked_for`, without starting it.
    ///
    /// # Errors
    /// The program is rejected, or the link fails.
    pub fn load(
        &mut self,
        program: &UserProgram,
        linked_for: &str,
        is_forced: bool,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<(), HostError> {
        let image = image::of_program(program, linked_for, self.version().trim_end())?;
        self.0.load(&image, is_forced, progress).map_err(link)
    }

    /// Saves programs, `persist`, axes and coordinate system to the flash from which the controller starts. The threads
    /// in `startup` will start automatically at power-up, and no others; `None` leaves that setting unchanged. Takes
    /// about 7 s.
    ///
    /// # Errors
    /// The controller does not answer, or does not confirm that flash equals memory.
    pub fn save(&mut self, startup: Option<&[ThreadId]>) -> Result<(), WireError> {
        for thread in ThreadId::all().filter(|_| startup.is_some()) {
            self.0.set_startup(thread, startup.is_some_and(|threads| threads.contains(&thread)))?;
        }
        self.0.save_to_flash()
    }
}
