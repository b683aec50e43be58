//! The PC connected to the board: its disk, its answers to programs, and the bytes that it sends.

mod answers;
mod boxes;
pub(crate) mod directory;
pub(crate) mod disk;
mod downloads;
pub(crate) mod files;
mod gcode;
pub(crate) mod host;
mod link;
mod remote;
mod requests;

pub use answers::{AnswerError, Answers, HELP as ANSWERS_HELP};
pub use boxes::OpenBox;
pub(crate) use downloads::Downloads;
pub(crate) use link::{ByteLink, ReceivedItem};
pub use remote::{RemoteBoard, RequestServer};
pub use requests::is_request;

use kmotiondef::Cycles;

use crate::out::{EventKind, Out};
use crate::pc::disk::Disk;
use crate::pc::files::HostFiles;
use crate::pc::host::Host;

/// The PC and its connections to the board.
#[derive(Clone, Debug)]
pub(crate) struct Pc {
    pub(crate) host: Host,
    pub(crate) disk: Disk,
    /// The links over USB and over the UART.
    pub(crate) usb: ByteLink,
    pub(crate) uart: ByteLink,
    /// The programs that it has downloaded into threads.
    pub(crate) downloads: Downloads,
    /// True if it takes console lines; otherwise they wait in the queue, and then programs wait, too.
    pub(crate) is_heard: bool,
}

impl Pc {
    /// A PC that keeps its files in `files`.
    pub(crate) fn new(files: Box<dyn HostFiles>) -> Self {
        Self {
            host: Host::default(),
            disk: Disk::new(files),
            usb: ByteLink::default(),
            uart: ByteLink::default(),
            downloads: Downloads::default(),
            is_heard: true,
        }
    }

    /// Takes a console line. Requests for files are handled here; other lines are shown.
    pub(crate) fn take_line(&mut self, out: &mut Out, line: Vec<u8>, now: Cycles) {
        if !self.host.is_connected() || !self.disk.take(out, &line, now) {
            out.emit(now, EventKind::ConsoleLine(line));
        }
    }

    /// Drops the bytes that the restarting board has not taken.
    pub(crate) fn restart(&mut self) {
        self.disk.forget_answers();
        self.usb = ByteLink::default();
        self.uart = ByteLink::default();
        self.downloads = Downloads::default();
    }
}
