//! Serial ports: the board's virtual COM port, or a pseudo-terminal. Source: wire.md section 4.

use std::io;
use std::time::Duration;

use serialport::{ClearBuffer, ErrorKind, FlowControl, SerialPort};

use crate::error::WireError;
use crate::link::BoardLink;

/// Time-out of a single read or write.
const STEP: Duration = Duration::from_millis(50);
/// The board has no speed; drivers need one.
const BAUD: u32 = 9600;

pub(super) fn open(path: &str, place: String) -> Result<BoardLink, WireError> {
    let port = serialport::new(path, BAUD).timeout(STEP).flow_control(FlowControl::None).open();
    let port = port.map_err(|error| refused(error, place.clone()))?;
    // What an earlier user has left; the handshake finds its place without this as well.
    let _ = port.clear(ClearBuffer::All);
    let writer = port.try_clone().map_err(|error| refused(error, place.clone()))?;
    Ok(BoardLink::new(place, Port(port), Port(writer)))
}

/// A port as a stream. A read of nothing is the end of the port.
struct Port(Box<dyn SerialPort>);

impl io::Read for Port {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.read(buffer)
    }
}

impl io::Write for Port {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    /// Written bytes are the driver's; waiting until they are sent could take forever.
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn refused(error: serialport::Error, place: String) -> WireError {
    match error.kind() {
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => WireError::NoSerialPermission { place },
        ErrorKind::NoDevice if error.description.contains("busy") || error.description.contains("lock") => {
            WireError::Busy { place, holder: "another program".into() }
        }
        ErrorKind::Io(io::ErrorKind::ResourceBusy | io::ErrorKind::WouldBlock) => {
            WireError::Busy { place, holder: "another program".into() }
        }
        _ => WireError::Open { place, error: error.into() },
    }
}
