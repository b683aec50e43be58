//! Raw bytes over TCP: a serial port of `ser2net`, or a Kogna.

use std::io;
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use crate::error::WireError;
use crate::link::BoardLink;

/// The time limit for connecting.
const CONNECT_WITHIN: Duration = Duration::from_secs(3);
/// Time-out of a single read or write.
const STEP: Duration = Duration::from_millis(50);

pub(super) fn open(host: &str, port: u16, place: String) -> Result<BoardLink, WireError> {
    let fail = |error| WireError::Open { place: place.clone(), error };
    let stream = connect(host, port).map_err(fail)?;
    let writer = stream.try_clone().map_err(fail)?;
    Ok(BoardLink::new(place, stream, writer))
}

/// Connects to the first address of a host that accepts.
pub(super) fn connect(host: &str, port: u16) -> io::Result<TcpStream> {
    let mut last = io::Error::new(io::ErrorKind::NotFound, "the host has no address");
    for address in (host, port).to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, CONNECT_WITHIN) {
            Ok(stream) => {
                stream.set_nodelay(true)?;
                stream.set_read_timeout(Some(STEP))?;
                stream.set_write_timeout(Some(STEP))?;
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}
