//! The named pipe of Windows through which programs reach the vendor's server. Source: wire.md section 7.

use super::messages::Messages;
use crate::error::WireError;

/// Returns whether a server listens.
#[cfg(windows)]
pub(crate) fn is_served() -> bool {
    windows::connect().is_ok()
}

/// Connects to the server.
#[cfg(windows)]
pub(super) fn open(place: &str) -> Result<impl Messages + use<>, WireError> {
    let file = windows::connect().map_err(|error| WireError::Open { place: place.to_owned(), error })?;
    Ok(super::messages::Unframed(file))
}

/// Returns an error: this system has no such pipes.
#[cfg(not(windows))]
pub(super) fn open(place: &str) -> Result<impl Messages + use<>, WireError> {
    Err::<super::messages::Unframed<std::fs::File>, _>(WireError::NotBuilt {
        place: place.to_owned(),
        reason: "named pipes are of Windows; server, server:PATH and server:HOST:PORT work here".into(),
    })
}

#[cfg(windows)]
mod windows {
    use std::fs::{File, OpenOptions};
    use std::io;
    use std::time::Duration;

    use crate::clock::now;

    /// The name of the vendor's pipe.
    const PIPE: &str = r"\\.\pipe\kmotionpipe";
    /// The system's error number if all instances of a pipe have a client.
    const BUSY: i32 = 231;
    /// The time limit for the server to accept another client, and the interval between attempts.
    const FREE_WITHIN: Duration = Duration::from_secs(3);
    const TRY_EACH: Duration = Duration::from_millis(20);

    pub(super) fn connect() -> io::Result<File> {
        let end = now() + FREE_WITHIN;
        loop {
            match OpenOptions::new().read(true).write(true).open(PIPE) {
                Err(error) if error.raw_os_error() == Some(BUSY) && now() < end => {
                    std::thread::sleep(TRY_EACH);
                }
                opened => return opened,
            }
        }
    }
}
