//! A connected controller, before programs are loaded.

use cc67_host::{HostError, Session, Setup};
use cc67_wire::{Address, Client, Progress, WireError};
use compiler::Options;
use compiler::firmware::Firmware;
use compiler::target::Target as CodeTarget;
use kmotiondef::ThreadId;
use kmotiondef::boards::TargetBoard;

use crate::controller::Controller;
use crate::terms::LoadTerms;

/// A connected controller, before programs are loaded.
#[derive(Debug)]
pub struct ControllerLink(pub(crate) Client);

impl ControllerLink {
    /// Connects to the controller at an address.
    ///
    /// # Errors
    /// There is no controller at the address, access is denied, or it does not answer.
    pub fn open(address: &Address) -> Result<Self, WireError> {
        Client::connect(address).map(Self)
    }

    /// Returns the version text of the controller's firmware.
    #[must_use]
    pub fn version(&self) -> &str {
        self.0.version()
    }

    /// Returns the location of the controller, for messages.
    #[must_use]
    pub fn place(&self) -> &str {
        self.0.place()
    }

    /// Returns the board of this firmware; `None` for an unknown version.
    #[must_use]
    pub fn board(&self) -> Option<&'static TargetBoard> {
        TargetBoard::of_version(self.version().trim_end())
    }

    /// Returns the options for programs and expressions of this controller: its processor and its firmware.
    #[must_use]
    pub fn options(&self) -> Options {
        let other = self.board().filter(|board| !board.is_default());
        let firmware = other.map_or_else(Firmware::default, Firmware::Board);
        Options { firmware, target: CodeTarget::C67x, ..Options::default() }
    }

    /// Loads the programs of a setup, and starts those marked as started.
    ///
    /// From the setup, the controller takes the programs, the values of `persist.UserData`, the PC's files, and the
    /// stimulus's actions of a person and the PC. `progress` is called after each block of a download.
    ///
    /// # Errors
    /// A program is rejected, a value is not in `persist.UserData`, the stimulus needs a model of the machine, or the
    /// link fails.
    pub fn session(
        self,
        setup: Setup,
        terms: LoadTerms,
        progress: impl FnMut(ThreadId, Progress) + Send + 'static,
    ) -> Result<Session<Controller>, HostError> {
        let Setup { config, options, programs, offered, values, stimulus, .. } = setup;
        let mut target = Controller::new(self.0, &options, terms, Box::new(progress));
        target.serve(config.files, config.answers);
        target.start_stimulus(stimulus)?;
        target.begin(&programs, &values)?;
        Ok(Session::on_target(target, options, programs, offered))
    }
}
