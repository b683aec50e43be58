//! The link to a controller, before it is a board.

use std::sync::{Mutex, PoisonError};

use cc67_controller::{Address, ControllerLink, FIRST_TIME, LoadTerms};
use pyo3::prelude::*;

use crate::errors::{LinkError, input};

/// A controller that answers.
#[pyclass(frozen)]
pub(crate) struct Controller {
    /// The link, until a board takes it.
    link: Mutex<Option<ControllerLink>>,
    /// The name of the board whose firmware this is; `None` for a version that is not known.
    #[pyo3(get)]
    board: Option<&'static str>,
    /// The controller's own words for its firmware.
    #[pyo3(get)]
    version: String,
}

#[pymethods]
impl Controller {
    #[new]
    fn new(py: Python<'_>, address: &str) -> PyResult<Self> {
        let address: Address = address.parse().map_err(input)?;
        let link = py.detach(|| ControllerLink::open(&address));
        let link = link.map_err(|error| LinkError::new_err(error.to_string()))?;
        let board = link.board().map(|board| board.name);
        let version = link.version().trim_end().to_owned();
        Ok(Self { link: Mutex::new(Some(link)), board, version })
    }
}

impl Controller {
    /// Takes the link; a controller becomes one board.
    pub(crate) fn take(&self) -> PyResult<ControllerLink> {
        let link = self.link.lock().unwrap_or_else(PoisonError::into_inner).take();
        link.ok_or_else(|| LinkError::new_err("the link belongs to a board already"))
    }
}

/// The terms on which programs are loaded, as `connect` passes them.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct ControllerTerms {
    force: bool,
    verify: bool,
    monitor: bool,
}

impl From<ControllerTerms> for LoadTerms {
    fn from(terms: ControllerTerms) -> Self {
        let ControllerTerms { force, verify, monitor } = terms;
        Self { is_forced: force, verifies: verify, has_monitor: monitor, ..Self::default() }
    }
}

/// Return what a person should know before the first connection.
#[pyfunction]
pub(crate) const fn first_time() -> &'static str {
    FIRST_TIME
}
