//! Serial ports: the board's virtual COM port, or a pseudo-terminal. Source: wire.md section 4.

use std::io;
use std::time::Duration;

use serialport::{ClearBuffer, ErrorKind, FlowControl, SerialPort};

use crate::error::WireError;
use crate::link::BoardLink;

/// Time-out of a single read or write.
const STEP: Duration = Duration::from_millis(50);
/// The baud rate, which drivers need; the board has none.
const BAUD: u32 = 9600;

pub(super) fn open(path: &str, place: String) -> Result<BoardLink, WireError> {
    let port = serialport::new(path, BAUD).timeout(STEP).flow_control(FlowControl::None).open();
    let port = port.map_err(|error| refused(error, place.clone()))?;
    // Data left over from an earlier user; the handshake copes with them in any case.
    let _ = port.clear(ClearBuffer::All);
    let writer = port.try_clone().map_err(|error| refused(error, place.clone()))?;
    Ok(BoardLink::new(place, Port(port), Port(writer)))
}

/// A port as a stream. An empty read is the end of the stream.
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

    /// Does nothing: written bytes are the driver's, and waiting until they are sent could take forever.
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
