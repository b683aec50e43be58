//! The choice of a board among those at USB, whatever lists them.

use std::time::Duration;

use crate::clock::now;
use crate::error::WireError;
use crate::link::BoardLink;

/// One of these words is in the name of a board at USB.
pub(super) const BOARD_NAMES: [&str; 3] = ["KFLOP", "KMotion", "Dynomotion"];
/// The time that a board needs to start, in which it comes and goes, and the interval of attempts.
const OPEN_WITHIN: Duration = Duration::from_secs(3);
const OPEN_EACH: Duration = Duration::from_millis(100);

/// A device that may be chosen.
pub(super) trait Candidate {
    /// Its location, as the system tells devices apart.
    fn location(&self) -> String;
    /// Returns whether a person means it by a location or a serial number.
    fn is_meant(&self, wanted: &str) -> bool;
}

/// Returns the device that is wanted, or else the only one.
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

/// Opens a link, again and again while the board may be starting.
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
