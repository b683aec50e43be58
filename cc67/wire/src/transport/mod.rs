//! Links of every kind.

#[cfg(feature = "usb")]
mod choice;
#[cfg(all(feature = "usb", any(windows, test)))]
mod d2xx;
pub mod ftdi;
mod kogna;
mod messages;
mod pipe;
#[cfg(feature = "serial")]
mod serial;
mod server;
mod tcp;
#[cfg(all(feature = "usb", not(windows)))]
mod usb;

#[cfg(all(feature = "usb", windows))]
use d2xx as usb;
pub use kogna::kognas;
#[cfg(windows)]
pub(crate) use pipe::is_served;
#[cfg(feature = "usb")]
pub(crate) use usb::boards as usb_boards;

use crate::address::Address;
use crate::error::WireError;
use crate::link::BoardLink;

/// Opens the link to the board at an address. Nothing is sent to the board yet.
///
/// # Errors
/// Nothing is connected at the address, or access is denied.
pub fn open(address: &Address) -> Result<BoardLink, WireError> {
    let place = address.to_string();
    match address {
        #[cfg(feature = "usb")]
        Address::Usb(location) => usb::open(location.as_deref()),
        #[cfg(not(feature = "usb"))]
        Address::Usb(_) => Err(not_built(place, "usb")),
        #[cfg(feature = "serial")]
        Address::Serial(path) => serial::open(path, place),
        #[cfg(not(feature = "serial"))]
        Address::Serial(_) => Err(not_built(place, "serial")),
        Address::Server(server) => server::open(server, place),
        Address::Kogna(serial) => kogna::open(*serial, place),
        Address::Tcp { host, port } => tcp::open(host, *port, place),
    }
}

#[cfg(not(all(feature = "usb", feature = "serial")))]
fn not_built(place: String, feature: &str) -> WireError {
    WireError::NotBuilt { place, reason: format!("this build has no such links (feature `{feature}`)") }
}
