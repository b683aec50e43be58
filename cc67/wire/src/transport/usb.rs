//! Direct access to the board's USB chip, without the vendor's driver. Source: wire.md section 2.

use std::io::{self, Read, Write};
use std::time::Duration;

use nusb::transfer::{Buffer, Bulk, ControlOut, ControlType, In, Out, Recipient, TransferError};
use nusb::{DeviceInfo, Endpoint, ErrorKind, Interface, MaybeFuture};

use super::choice::{BOARD_NAMES, Candidate, choose, open_patiently};
use super::ftdi;
use crate::error::WireError;
use crate::found::FoundBoard;
use crate::link::BoardLink;

/// The vendor's USB identifier, and the product identifiers of its boards: KFLOP, KMotion.
const VENDOR: u16 = 0x0403;
const PRODUCTS: [u16; 2] = [0xF231, 0xF230];
/// Endpoints for data.
const IN: u8 = 0x81;
const OUT: u8 = 0x02;
/// Time-out of a request to the chip.
const CONTROL: Duration = Duration::from_secs(1);
/// Time-out of a single read or write.
const STEP: Duration = Duration::from_millis(50);
/// The size of a transfer in bytes, and the number of transfers in progress.
const TRANSFER: usize = 4096;
const TRANSFERS: usize = 4;

pub(super) fn open(location: Option<&str>) -> Result<BoardLink, WireError> {
    open_patiently(|| choose(devices()?, location).and_then(|device| claim(&device)))
}

impl Candidate for DeviceInfo {
    fn location(&self) -> String {
        location_of(self)
    }

    fn is_meant(&self, wanted: &str) -> bool {
        location_of(self) == wanted || self.serial_number() == Some(wanted)
    }
}

/// The devices that may be boards.
fn devices() -> Result<Vec<DeviceInfo>, WireError> {
    let all = nusb::list_devices().wait();
    let all = all.map_err(|error| WireError::Open { place: "usb".into(), error: error.into() })?;
    Ok(all.filter(is_board).collect())
}

fn is_board(device: &DeviceInfo) -> bool {
    let is_known = device.vendor_id() == VENDOR && PRODUCTS.contains(&device.product_id());
    // If the operating system does not report the name, the identifier decides.
    is_known && device.product_string().is_none_or(|name| BOARD_NAMES.iter().any(|word| name.contains(word)))
}

/// Bus and ports of a device, in the notation of Linux.
fn location_of(device: &DeviceInfo) -> String {
    let bus = device.bus_id();
    let bus = bus.trim_start_matches('0');
    let ports: Vec<String> = device.port_chain().iter().map(u8::to_string).collect();
    format!("{}-{}", if bus.is_empty() { "0" } else { bus }, ports.join("."))
}

/// Opens the chip and prepares it.
fn claim(device: &DeviceInfo) -> Result<BoardLink, WireError> {
    let location = location_of(device);
    let place = format!("usb:{location}");
    let fail = |error: nusb::Error| match error.kind() {
        ErrorKind::PermissionDenied => WireError::NoPermission { place: place.clone() },
        ErrorKind::Busy => WireError::Busy { place: place.clone(), holder: holder(&location) },
        _ => WireError::Open { place: place.clone(), error: error.into() },
    };
    let opened = device.open().wait().map_err(fail)?;
    let interface = opened.detach_and_claim_interface(0).wait().map_err(fail)?;
    prepare(&interface).map_err(|error| WireError::Open { place: place.clone(), error: error.into() })?;
    let input: Endpoint<Bulk, In> = interface.endpoint(IN).map_err(fail)?;
    let output: Endpoint<Bulk, Out> = interface.endpoint(OUT).map_err(fail)?;
    Ok(BoardLink::new(place, ChipReader::new(input), ChipWriter { output }))
}

fn prepare(interface: &Interface) -> Result<(), TransferError> {
    for ftdi::ChipRequest { request, value } in ftdi::PREPARATION {
        let control = ControlOut {
            control_type: ControlType::Vendor,
            recipient: Recipient::Device,
            request,
            value,
            index: 1,
            data: &[],
        };
        interface.control_out(control, CONTROL).wait()?;
    }
    Ok(())
}

/// The program that uses a device, as far as Linux reports it: the driver of its interface.
fn holder(location: &str) -> String {
    let driver = std::fs::read_link(format!("/sys/bus/usb/devices/{location}:1.0/driver"));
    let driver = driver.ok().and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    match driver.as_deref() {
        None => "another program".into(),
        Some("usbfs") => "another program, perhaps the vendor's server".into(),
        Some(driver) => format!("the kernel's driver {driver}"),
    }
}

/// The boards at USB.
pub(crate) fn boards() -> Result<Vec<FoundBoard>, WireError> {
    let row = |device: &DeviceInfo| {
        let location = location_of(device);
        let is_held = std::fs::read_link(format!("/sys/bus/usb/devices/{location}:1.0/driver")).is_ok();
        FoundBoard {
            name: device.product_string().unwrap_or("KFLOP").to_owned(),
            serial: device.serial_number().map(str::to_owned),
            holder: is_held.then(|| holder(&location)),
            address: format!("usb:{location}"),
        }
    };
    Ok(devices()?.iter().map(row).collect())
}

/// The data from the chip. Several transfers are always in progress; an empty one is not the end.
struct ChipReader {
    input: Endpoint<Bulk, In>,
    fresh: Vec<u8>,
    taken: usize,
}

impl ChipReader {
    fn new(mut input: Endpoint<Bulk, In>) -> Self {
        (0..TRANSFERS).for_each(|_| input.submit(Buffer::new(TRANSFER)));
        Self { input, fresh: Vec::new(), taken: 0 }
    }
}

impl Read for ChipReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.taken >= self.fresh.len() {
            self.fresh.clear();
            self.taken = 0;
            let Some(completion) = self.input.wait_next_complete(STEP) else {
                return Err(io::ErrorKind::TimedOut.into());
            };
            let mut transfer = completion.into_result()?;
            ftdi::strip(&transfer, self.input.max_packet_size(), &mut self.fresh);
            transfer.clear();
            transfer.set_requested_len(TRANSFER);
            self.input.submit(transfer);
            if self.fresh.is_empty() {
                return Err(io::ErrorKind::TimedOut.into());
            }
        }
        let rest = self.fresh.get(self.taken..).unwrap_or_default();
        let count = rest.len().min(buffer.len());
        if let (Some(to), Some(from)) = (buffer.get_mut(..count), rest.get(..count)) {
            to.copy_from_slice(from);
        }
        self.taken += count;
        Ok(count)
    }
}

/// The data to the chip: the transfer waits while the board does not read.
struct ChipWriter {
    output: Endpoint<Bulk, Out>,
}

impl Write for ChipWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.output.pending() == 0 {
            self.output.submit(bytes.to_vec().into());
        }
        match self.output.wait_next_complete(STEP) {
            // The caller tries again with the same bytes.
            None => Err(io::ErrorKind::TimedOut.into()),
            Some(completion) => {
                completion.status?;
                Ok(completion.actual_len)
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
