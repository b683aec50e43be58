//! Pseudo-terminals: one end is ours, and other programs open the other end by its name.

use std::fs::File;
use std::io::{self, Read, Write};

use anyhow::Result;

/// Our end of a pseudo-terminal in raw mode.
#[derive(Debug)]
pub(crate) struct Terminal {
    controller: File,
    /// The other end, kept open: otherwise the line would fail while no other program has it open.
    _line: File,
    name: String,
}

impl Terminal {
    /// Opens a new one.
    #[cfg(unix)]
    pub(crate) fn open() -> Result<Self> {
        use anyhow::Context as _;
        use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
        use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

        let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).context("cannot open a terminal")?;
        grantpt(&controller)?;
        unlockpt(&controller)?;
        let name = ptsname(&controller, Vec::new())?.to_string_lossy().into_owned();
        let line = std::fs::OpenOptions::new().read(true).write(true).open(&name)?;
        let mut mode = tcgetattr(&line)?;
        mode.make_raw();
        tcsetattr(&line, OptionalActions::Now, &mode)?;
        Ok(Self { controller: controller.into(), _line: line, name })
    }

    /// Returns an error: this system has no pseudo-terminals.
    #[cfg(not(unix))]
    pub(crate) fn open() -> Result<Self> {
        anyhow::bail!("this system has no pseudo-terminals; a TCP port works everywhere")
    }

    /// The path for other programs.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// A second handle for our end.
    pub(crate) fn controller(&self) -> io::Result<File> {
        self.controller.try_clone()
    }
}

impl Read for Terminal {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.controller.read(buffer)
    }
}

impl Write for Terminal {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.controller.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.controller.flush()
    }
}
