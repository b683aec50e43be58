//! Kogna controllers on the networks of this computer.
//!
//! A query is sent as a datagram to a multicast group on each local network; each controller answers to a fixed port of
//! the sender. The link itself is TCP. Source: kogna.md, Link and loading.

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::time::Duration;

use crate::address::BOARD_PORT;
use crate::clock::now;
use crate::error::WireError;
use crate::found::FoundBoard;
use crate::link::BoardLink;
use crate::transport::tcp;

/// The multicast group of the query, and its port.
const GROUP: SocketAddrV4 = SocketAddrV4::new(Ipv4Addr::new(239, 81, 92, 240), 25000);
/// The port to which controllers answer.
const ANSWER_PORT: u16 = 25001;
/// The maximum number of routers on the way of a query.
const HOPS: u32 = 8;
/// The size of a query and of an answer in bytes.
const DATAGRAM: usize = 64;
const QUESTION: &[u8] = b"Kogna?";
const ANSWER: &[u8] = b"I am Kogna SN";
/// The time limit for answers.
const ANSWER_WITHIN: Duration = Duration::from_millis(500);
/// The networks that are searched: private ones, by the first number of the local address.
const FIRST_NUMBERS: [u8; 3] = [10, 172, 192];

/// A controller that has answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Kogna {
    address: Ipv4Addr,
    serial: u32,
}

/// Searches the networks of this computer for Kogna controllers, and lists those that answer within half a second.
///
/// # Errors
/// The operating system cannot list the networks, or another program waits for the answers.
pub fn kognas() -> Result<Vec<FoundBoard>, WireError> {
    let board = |kogna: Kogna| FoundBoard {
        address: format!("tcp:{}:{BOARD_PORT}", kogna.address),
        name: "Kogna".into(),
        serial: Some(kogna.serial.to_string()),
        holder: None,
    };
    Ok(search().map_err(WireError::KognaSearch)?.into_iter().map(board).collect())
}

/// Opens the link to the controller with a serial number, or to the only one.
pub(super) fn open(wanted: Option<u32>, place: String) -> Result<BoardLink, WireError> {
    let found = search().map_err(WireError::KognaSearch)?;
    let kogna = choose(&found, wanted).ok_or_else(|| not_found_error(&found, wanted))?;
    tcp::open(&kogna.address.to_string(), BOARD_PORT, place)
}

/// The controller with this serial number, or the only one.
fn choose(found: &[Kogna], wanted: Option<u32>) -> Option<Kogna> {
    match (wanted, found) {
        (Some(wanted), found) => found.iter().copied().find(|kogna| kogna.serial == wanted),
        (None, [only]) => Some(*only),
        (None, _) => None,
    }
}

/// The error when no controller could be selected.
fn not_found_error(found: &[Kogna], wanted: Option<u32>) -> WireError {
    let name = |kogna: &Kogna| format!("kogna:{} at {}", kogna.serial, kogna.address);
    let present = found.iter().map(name).collect::<Vec<_>>().join(", ");
    match wanted {
        None if !found.is_empty() => WireError::SeveralBoards(present),
        None => WireError::NoKogna { serial: String::new(), present: "none".into() },
        Some(number) => WireError::NoKogna {
            serial: format!(" with serial number {number}"),
            present: if present.is_empty() { "none".into() } else { present },
        },
    }
}

fn search() -> io::Result<Vec<Kogna>> {
    let local: Vec<_> =
        if_addrs::get_if_addrs()?.iter().filter_map(|network| private(network.ip())).collect();
    query(&local, GROUP, ANSWER_PORT)
}

/// A local address whose network is searched.
fn private(address: IpAddr) -> Option<Ipv4Addr> {
    let IpAddr::V4(address) = address else { return None };
    FIRST_NUMBERS.contains(&address.octets()[0]).then_some(address)
}

/// Sends the query from each local address, and collects the answers to a port.
fn query(local: &[Ipv4Addr], group: SocketAddrV4, port: u16) -> io::Result<Vec<Kogna>> {
    let mut question = [0; DATAGRAM];
    question[..QUESTION.len()].copy_from_slice(QUESTION);
    let mut sockets = Vec::new();
    for address in local {
        let socket = UdpSocket::bind((*address, port))?;
        socket.set_multicast_ttl_v4(HOPS)?;
        // A network without a route to the group has no reachable controller.
        if socket.send_to(&question, group).is_ok() {
            sockets.push(socket);
        }
    }
    let end = now() + ANSWER_WITHIN;
    let mut found = Vec::new();
    // One socket after another: the operating system keeps the data that arrive at the others meanwhile.
    for socket in &sockets {
        while let Some((sender, bytes)) = receive(socket, end)? {
            found.extend(answer(sender, &bytes).filter(|kogna| !found.contains(kogna)));
        }
    }
    found.sort_by_key(|kogna| kogna.serial);
    Ok(found)
}

/// The next datagram, if one comes before a given time.
fn receive(socket: &UdpSocket, end: std::time::Instant) -> io::Result<Option<(SocketAddr, Vec<u8>)>> {
    let left = end.saturating_duration_since(now()).max(Duration::from_millis(1));
    socket.set_read_timeout(Some(left))?;
    let mut bytes = [0; DATAGRAM];
    match socket.recv_from(&mut bytes) {
        Ok((length, sender)) => Ok(Some((sender, bytes.get(..length).unwrap_or_default().to_vec()))),
        Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => Ok(None),
        Err(error) => Err(error),
    }
}

/// The controller that sent an answer; other data at this port are ignored.
fn answer(sender: SocketAddr, bytes: &[u8]) -> Option<Kogna> {
    let SocketAddr::V4(sender) = sender else { return None };
    let text = bytes.strip_prefix(ANSWER)?;
    let text = std::str::from_utf8(text.split(|byte| *byte == 0).next()?).ok()?;
    Some(Kogna { address: *sender.ip(), serial: text.trim().parse().ok()? })
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    #[test]
    fn controllers_that_answer_are_found_and_others_ignored() {
        let board = UdpSocket::bind("127.0.0.1:0").expect("there is a port");
        let SocketAddr::V4(group) = board.local_addr().expect("it is bound") else { panic!("it is IPv4") };
        let free = UdpSocket::bind("127.0.0.1:0").expect("there is a port");
        let port = free.local_addr().expect("it is bound").port();
        drop(free);
        let answering = thread::spawn(move || {
            let mut question = [0; 128];
            let (length, from) = board.recv_from(&mut question).expect("it is asked");
            for text in [
                &b"hello"[..],
                b"I am Kogna SN",
                b"I am Kogna SN12\0\0",
                b"I am Kogna SN12",
                b"I am Kogna SN 7",
            ] {
                board.send_to(text, from).expect("it is sent");
            }
            question.get(..length).map(<[u8]>::to_vec)
        });
        let found = query(&[Ipv4Addr::LOCALHOST], group, port).expect("the network is there");
        let question = answering.join().expect("it has answered").expect("it fits");
        assert!(question.len() == DATAGRAM && question.starts_with(b"Kogna?\0"), "{question:?}");
        assert_eq!(found.iter().map(|kogna| kogna.serial).collect::<Vec<_>>(), [7, 12]);
    }

    #[test]
    fn the_only_controller_or_the_wanted_one_is_chosen() {
        let kogna = |serial| Kogna { address: Ipv4Addr::new(10, 0, 0, 5), serial };
        let two = [kogna(7), kogna(12)];
        assert_eq!(choose(&two[..1], None), Some(kogna(7)));
        assert_eq!(choose(&two, Some(12)), Some(kogna(12)));
        for (found, wanted, expect) in [
            (&two[..], None, "several boards are connected: kogna:7 at 10.0.0.5, kogna:12 at 10.0.0.5"),
            (&two[..1], Some(9), "no Kogna with serial number 9 answers"),
            (&[], None, "no Kogna answers"),
        ] {
            assert_eq!(choose(found, wanted), None);
            let error = not_found_error(found, wanted).to_string();
            assert!(error.starts_with(expect), "{error}");
        }
    }
}
