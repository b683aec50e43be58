//! The boards connected to this computer.

use crate::error::WireError;
use crate::found::FoundBoard;

/// Lists the connected boards. Nothing is sent to any of them.
///
/// # Errors
/// The operating system cannot list its devices.
pub fn boards() -> Result<Vec<FoundBoard>, WireError> {
    #[cfg(feature = "usb")]
    let mut found = if has_usb() { crate::transport::usb_boards()? } else { Vec::new() };
    #[cfg(not(feature = "usb"))]
    let mut found = Vec::new();
    #[cfg(feature = "serial")]
    found.extend(serial_boards());
    found.extend(server());
    Ok(found)
}

/// Returns whether the operating system has USB at all; containers have none.
#[cfg(feature = "usb")]
fn has_usb() -> bool {
    !cfg!(target_os = "linux") || std::path::Path::new("/sys/bus/usb/devices").exists()
}

/// Serial ports that identify themselves as a board.
#[cfg(feature = "serial")]
fn serial_boards() -> Vec<FoundBoard> {
    use serialport::SerialPortType;

    let ports = serialport::available_ports().unwrap_or_default();
    let board = |port: serialport::SerialPortInfo| {
        let SerialPortType::UsbPort(usb) = port.port_type else { return None };
        ((usb.vid, usb.pid) == (0x0403, 0xF231)).then(|| FoundBoard {
            address: format!("serial:{}", port.port_name),
            name: usb.product.unwrap_or_else(|| "KFLOP".into()),
            serial: usb.serial_number,
            holder: None,
        })
    };
    ports.into_iter().filter_map(board).collect()
}

/// The vendor's server, if one listens at its default address.
fn server() -> Option<FoundBoard> {
    let place = served_at()?;
    Some(FoundBoard {
        address: "server".into(),
        name: format!("board of the server at {place}"),
        serial: None,
        holder: Some("the server".into()),
    })
}

/// The default address of the vendor's server, if it listens there.
#[cfg(unix)]
fn served_at() -> Option<&'static str> {
    let socket = "/tmp/kmotionsocket";
    std::os::unix::net::UnixStream::connect(socket).ok().map(|_| socket)
}

#[cfg(windows)]
fn served_at() -> Option<&'static str> {
    crate::transport::is_served().then_some(r"\\.\pipe\kmotionpipe")
}

#[cfg(not(any(unix, windows)))]
fn served_at() -> Option<&'static str> {
    None
}
