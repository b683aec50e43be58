//! The selection of one board from those connected to USB, independent of the driver.

use std::time::Duration;

use crate::clock::now;
use crate::error::WireError;
use crate::link::BoardLink;

/// Words of which one is in the USB name of a board.
pub(super) const BOARD_NAMES: [&str; 3] = ["KFLOP", "KMotion", "Dynomotion"];
/// The time for retries while a board starts, during which it appears and disappears, and the interval between
/// attempts.
const OPEN_WITHIN: Duration = Duration::from_secs(3);
const OPEN_EACH: Duration = Duration::from_millis(100);

/// A device that may be selected.
pub(super) trait Candidate {
    /// Its location, which distinguishes it from other devices.
    fn location(&self) -> String;
    /// Returns whether a user's location or serial number refers to it.
    fn is_meant(&self, wanted: &str) -> bool;
}

/// Returns the requested device, or the only one if none was requested.
pub(super) fn choose<D: Candidate>(mut devices: Vec<D>, wanted: Option<&str>) -> Result<D, WireError> {
    let present = devices.iter().map(D::location).collect::<Vec<_>>().join(", ");
    if let Some(wanted) = wanted {
        let Some(index) = devices.iter().position(|device| device.is_meant(wanted)) else {
            let present = if present.is_empty() { "none".into() } else { present };
            return Err(WireError::NotThere { wanted: wanted.into(), present });
        };
        return Ok(devices.swap_remove(index));
    }
    match devices.len() {
        1 => Ok(devices.swap_remove(0)),
        0 => Err(WireError::NoBoard),
        _ => Err(WireError::SeveralBoards(present)),
    }
}

/// Opens a link, with repeated attempts while the board may be starting.
pub(super) fn open_patiently(
    open: impl Fn() -> Result<BoardLink, WireError>,
) -> Result<BoardLink, WireError> {
    let end = now() + OPEN_WITHIN;
    loop {
        match open() {
            Err(WireError::Open { .. }) if now() < end => std::thread::sleep(OPEN_EACH),
            result => return result,
        }
    }
}
