//! Files of the PC, for programs on the controller.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cc67_wire::{DiskAnswer, PcFiles};
use runtime::{FileAnswer, FileServer, HostFiles};

/// Remarks about requests for files, not yet delivered as events.
#[derive(Clone, Debug, Default)]
pub(crate) struct FileRemarks(Arc<Mutex<Vec<String>>>);

impl FileRemarks {
    fn all(&self) -> MutexGuard<'_, Vec<String>> {
        // A list of texts is consistent at all times.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the remarks since the last call.
    pub(crate) fn take(&self) -> Vec<String> {
        std::mem::take(&mut *self.all())
    }
}

/// The files of one PC.
#[derive(Debug)]
pub(crate) struct Files {
    server: FileServer,
    remarks: FileRemarks,
}

impl Files {
    /// Serves files, and reports failures through `remarks`.
    pub(crate) fn new(files: Box<dyn HostFiles>, remarks: FileRemarks) -> Self {
        Self { server: FileServer::new(files), remarks }
    }
}

impl PcFiles for Files {
    fn request(&mut self, code: u8, text: &[u8]) -> Option<DiskAnswer> {
        let served = self.server.serve(code, text);
        self.remarks.all().extend(served.remark);
        served.answer.map(|answer| match answer {
            FileAnswer::Line(line) => DiskAnswer::Line(line),
            FileAnswer::End => DiskAnswer::End,
            FileAnswer::Failure => DiskAnswer::Failure,
        })
    }
}
