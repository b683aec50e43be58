//! Addresses of boards, as given to `--on`.

use std::fmt;
use std::str::FromStr;

/// The TCP port of the vendor's server.
const SERVER_PORT: u16 = 57777;
/// The socket of the vendor's server.
const SERVER_SOCKET: &str = "/tmp/kmotionsocket";
/// The TCP port at which a Kogna listens.
pub(crate) const BOARD_PORT: u16 = 2000;

/// The address of a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
    /// A USB device: the only one, or the one at a bus and port path (`1-2.3`) or with a serial number.
    Usb(Option<String>),
    /// A serial port, by its path or name.
    Serial(String),
    /// A board connected to the vendor's server.
    Server(ServerAddress),
    /// A Kogna in the networks of this computer: the only one, or the one with a serial number.
    Kogna(Option<u32>),
    /// Raw bytes over TCP.
    Tcp {
        /// Name or address of the computer.
        host: String,
        /// The TCP port.
        port: u16,
    },
}

/// The address of the vendor's server.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ServerAddress {
    /// A Unix socket.
    Socket(String),
    /// A TCP port.
    Tcp(String, u16),
    /// The named pipe of Windows.
    Pipe,
}

/// A name that is not an address of a board.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{name}` is not a board: {reason}; write usb, usb:LOCATION, serial:PATH, server, server:PATH, server:HOST:PORT, kogna, kogna:SERIAL or tcp:HOST:PORT"
)]
pub struct AddressError {
    name: String,
    reason: &'static str,
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(name: &str) -> Result<Self, AddressError> {
        let wrong = |reason| AddressError { name: name.to_owned(), reason };
        let (way, place) = name.split_once(':').map_or((name, None), |(way, place)| (way, Some(place)));
        if place == Some("") {
            return Err(wrong("nothing follows the colon"));
        }
        match (way, place) {
            ("usb", place) => Ok(Self::Usb(place.map(str::to_owned))),
            ("serial", Some(place)) => Ok(Self::Serial(place.to_owned())),
            ("serial", None) => Err(wrong("a serial port needs its path")),
            ("server", place) => server(place).map(Self::Server).map_err(wrong),
            ("kogna", None) => Ok(Self::Kogna(None)),
            ("kogna", Some(serial)) => match serial.parse() {
                Ok(serial) => Ok(Self::Kogna(Some(serial))),
                Err(_) => Err(wrong("a Kogna is chosen by its serial number, or by tcp:HOST")),
            },
            ("tcp", Some(place)) => {
                let (host, port) = host_and_port(place, BOARD_PORT).map_err(wrong)?;
                Ok(Self::Tcp { host, port })
            }
            ("tcp", None) => Err(wrong("a TCP connection needs its host")),
            _ => Err(wrong("unknown kind of link")),
        }
    }
}

/// Parses the address of a server; the default is the usual one on this system.
fn server(place: Option<&str>) -> Result<ServerAddress, &'static str> {
    match place {
        None if cfg!(windows) => Ok(ServerAddress::Pipe),
        None => Ok(ServerAddress::Socket(SERVER_SOCKET.to_owned())),
        Some("pipe") => Ok(ServerAddress::Pipe),
        Some(path) if path.contains('/') => Ok(ServerAddress::Socket(path.to_owned())),
        Some(place) => {
            let (host, port) = host_and_port(place, SERVER_PORT)?;
            Ok(ServerAddress::Tcp(host, port))
        }
    }
}

/// Splits `HOST:PORT`; the port may be missing.
fn host_and_port(place: &str, usual: u16) -> Result<(String, u16), &'static str> {
    let Some((host, port)) = place.rsplit_once(':') else { return Ok((place.to_owned(), usual)) };
    let port = port.parse().map_err(|_| "its port is not a number from 0 to 65535")?;
    Ok((if host.is_empty() { "localhost".to_owned() } else { host.to_owned() }, port))
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usb(None) => f.write_str("usb"),
            Self::Usb(Some(place)) => write!(f, "usb:{place}"),
            Self::Serial(path) => write!(f, "serial:{path}"),
            Self::Server(ServerAddress::Socket(path)) => write!(f, "server:{path}"),
            Self::Server(ServerAddress::Tcp(host, port)) => write!(f, "server:{host}:{port}"),
            Self::Server(ServerAddress::Pipe) => f.write_str("server:pipe"),
            Self::Kogna(None) => f.write_str("kogna"),
            Self::Kogna(Some(serial)) => write!(f, "kogna:{serial}"),
            Self::Tcp { host, port } => write!(f, "tcp:{host}:{port}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_and_printed() {
        for (text, printed) in [
            ("usb", "usb"),
            ("usb:1-2.3", "usb:1-2.3"),
            ("serial:/dev/ttyUSB0", "serial:/dev/ttyUSB0"),
            ("serial:COM3", "serial:COM3"),
            ("server:/run/kmotion", "server:/run/kmotion"),
            ("server:shop:57777", "server:shop:57777"),
            ("server:pipe", "server:pipe"),
            ("kogna", "kogna"),
            ("kogna:12", "kogna:12"),
            ("tcp:10.0.0.7", "tcp:10.0.0.7:2000"),
            ("tcp::4000", "tcp:localhost:4000"),
        ] {
            assert_eq!(text.parse::<Address>().map(|address| address.to_string()).as_deref(), Ok(printed));
        }
    }

    #[test]
    fn other_names_are_reported_with_those_that_exist() {
        for (text, expect) in [
            ("parallel", "unknown kind of link"),
            ("usb:", "nothing follows the colon"),
            ("serial", "needs its path"),
            ("tcp:host:http", "not a number"),
            ("kogna:10.0.0.7", "or by tcp:HOST"),
        ] {
            let error = text.parse::<Address>().expect_err("it is wrong").to_string();
            assert!(error.contains(expect) && error.contains("serial:PATH"), "{error}");
        }
    }
}
