//! Programs of cc67 in a free thread of the board: compiled for it, loaded, and controlled by a request in their
//! memory.

use std::path::Path;

use cc67_host::{HostError, UserProgram};
use cc67_wire::Client;
use compiler::Options;
use compiler::inspect::Inspection;
use kmotiondef::ThreadId;

use crate::image;

/// The variable for the request in each of these programs.
const REQUEST: &str = "cc67_request";

/// A program of cc67 for a board.
#[derive(Clone, Debug)]
pub(crate) struct ResidentProgram {
    /// The file name of its source.
    pub(crate) name: &'static str,
    /// Its source.
    pub(crate) source: &'static str,
    /// Its name in messages.
    pub(crate) title: &'static str,
}

impl ResidentProgram {
    /// Compiles it for a thread and loads it; returns the address of its request. `linked_for` is the version of the
    /// firmware in the options.
    ///
    /// # Errors
    /// The link fails, or the board has another firmware.
    pub(crate) fn load(
        &self,
        board: &mut Client,
        options: &Options,
        linked_for: &str,
        thread: ThreadId,
    ) -> Result<u32, HostError> {
        let program = UserProgram::compile_text(Path::new(self.name), self.source.into(), thread, options)?;
        let version = board.version().trim_end().to_owned();
        let loaded = image::of_program(&program, linked_for, &version)?;
        let failed = |text: String| HostError::Link(format!("{}: {text}", self.title));
        let inspected = Inspection::read(&program.image).map_err(|error| failed(error.to_string()))?;
        let symbol = inspected.symbols.iter().find(|symbol| symbol.name == REQUEST);
        let request = symbol.map(|symbol| symbol.address);
        let request = request.ok_or_else(|| failed("it has no request".to_owned()))?;
        board.load(&loaded, false, &mut |_| {}).map_err(|error| failed(error.to_string()))?;
        Ok(request)
    }
}
