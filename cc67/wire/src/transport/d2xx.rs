//! The library of the chip's Windows driver, loaded at run time. Source: wire.md sections 2.2 and 2.3.
//!
//! On Windows the vendor's driver controls the chip, and is accessible through its library, `ftd2xx.dll`. The library
//! is not linked: without it, or with an incompatible one, there is an error, and the COM port and the vendor's server
//! can be used instead.
//!
//! This file contains all unsafe code of this crate: functions of a library loaded at run time have the types given in
//! their documentation (FTDI, *D2XX Programmer's Guide*), which nothing checks.

#![expect(
    unsafe_code,
    reason = "functions of a library that is loaded at run time have the types that we say"
)]

use std::ffi::{OsStr, c_void};
use std::io::{self, Read, Write};
use std::sync::Arc;
use std::time::Duration;

use libloading::Library;

use super::choice::{BOARD_NAMES, Candidate, choose, open_patiently};
use super::ftdi;
use crate::error::WireError;
use crate::found::FoundBoard;
use crate::link::BoardLink;

/// The file name of the library.
#[cfg(windows)]
const LIBRARY: &str = "ftd2xx.dll";
/// Result codes of the library.
const OK: u32 = 0;
const DEVICE_NOT_FOUND: u32 = 2;
const DEVICE_NOT_OPENED: u32 = 3;
/// Opens the device at a location.
const BY_LOCATION: u32 = 4;
/// The flag of a device that a program has opened.
const OPENED: u32 = 1;
/// Purges both directions.
const BOTH: u32 = 3;
/// The sizes of a serial number and of a description in bytes, with their terminating 0.
const SERIAL: usize = 16;
const DESCRIPTION: usize = 64;
/// Time limit of a single write, in milliseconds; reads take only the bytes that are already there.
const STEP: u32 = 50;
/// The pause after a read that found nothing.
const PAUSE: Duration = Duration::from_millis(1);

type Handle = *mut c_void;

/// Declares the required functions, each with its name in the library.
macro_rules! functions {
    ($($name:ident = $symbol:literal ($($argument:ty),*);)*) => {
        /// The functions of the library.
        #[derive(Debug)]
        struct Functions {
            $($name: unsafe extern "system" fn($($argument),*) -> u32,)*
            /// Keeps the library loaded for the functions.
            _library: Library,
        }

        impl Functions {
            fn find(library: Library) -> Result<Self, libloading::Error> {
                $(
                    // SAFETY: the type is given in the library's documentation, and the function lives as long as the
                    // library, which is kept beside it.
                    let $name = *unsafe { library.get(concat!($symbol, "\0").as_bytes()) }?;
                )*
                Ok(Self { $($name,)* _library: library })
            }
        }
    };
}

functions! {
    create_list = "FT_CreateDeviceInfoList" (*mut u32);
    detail = "FT_GetDeviceInfoDetail" (u32, *mut u32, *mut u32, *mut u32, *mut u32, *mut c_void, *mut c_void, *mut Handle);
    open = "FT_OpenEx" (*mut c_void, u32, *mut Handle);
    set_latency = "FT_SetLatencyTimer" (Handle, u8);
    set_characters = "FT_SetChars" (Handle, u8, u8, u8, u8);
    set_timeouts = "FT_SetTimeouts" (Handle, u32, u32);
    purge = "FT_Purge" (Handle, u32);
    status = "FT_GetStatus" (Handle, *mut u32, *mut u32, *mut u32);
    read = "FT_Read" (Handle, *mut c_void, u32, *mut u32);
    write = "FT_Write" (Handle, *mut c_void, u32, *mut u32);
    close = "FT_Close" (Handle);
}

/// Converts the result of a function to an error, unless it is success.
fn check(result: u32) -> Result<(), DriverError> {
    if result == OK { Ok(()) } else { Err(DriverError(result)) }
}

/// A result of the library other than success.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct DriverError(u32);

impl From<DriverError> for io::Error {
    fn from(error: DriverError) -> Self {
        match error.0 {
            DEVICE_NOT_FOUND => Self::from(io::ErrorKind::NotFound),
            DEVICE_NOT_OPENED => Self::from(io::ErrorKind::ResourceBusy),
            number => Self::other(format!("the driver's library answers {number}")),
        }
    }
}

/// A device listed by the driver.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Device {
    location: u32,
    serial: String,
    description: String,
    is_opened: bool,
}

impl Device {
    fn address(&self) -> String {
        format!("usb:{}", self.location())
    }
}

impl Candidate for Device {
    fn location(&self) -> String {
        format!("{:08X}", self.location)
    }

    fn is_meant(&self, wanted: &str) -> bool {
        let location = u32::from_str_radix(wanted.trim_start_matches("0x"), 16);
        location == Ok(self.location) || !self.serial.is_empty() && self.serial == wanted
    }
}

/// Opens the link to the only board at USB, or to the one at a location or with a serial number.
#[cfg(windows)]
pub(super) fn open(location: Option<&str>) -> Result<BoardLink, WireError> {
    Driver::of_system()?.open(location)
}

/// The boards at USB; none if the driver is not installed.
#[cfg(windows)]
pub(crate) fn boards() -> Result<Vec<FoundBoard>, WireError> {
    Driver::of_system().map_or_else(|_| Ok(Vec::new()), |driver| driver.boards())
}

/// The driver.
#[derive(Clone, Debug)]
struct Driver(Arc<Functions>);

impl Driver {
    /// Loads the library installed on the system.
    #[cfg(windows)]
    fn of_system() -> Result<Self, WireError> {
        Self::load(LIBRARY.as_ref()).map_err(|error| WireError::NotBuilt {
            place: "usb".into(),
            reason: format!(
                "the library of the controller's driver cannot be used ({error}); it comes with the vendor's software; \
                 --on serial:COM3 (Device Manager: load VCP) and --on server work without it"
            ),
        })
    }

    /// Loads a library.
    fn load(file: &OsStr) -> Result<Self, libloading::Error> {
        // SAFETY: the library of a driver runs nothing dangerous when it is loaded; it is the one that the vendor's own
        // programs load.
        let library = unsafe { Library::new(file) }?;
        Functions::find(library).map(|functions| Self(Arc::new(functions)))
    }

    /// The boards among the driver's devices.
    fn devices(&self) -> Result<Vec<Device>, DriverError> {
        let mut count = 0;
        // SAFETY: the pointer refers to a number of that type.
        check(unsafe { (self.0.create_list)(&raw mut count) })?;
        let devices = (0..count).map(|index| self.device(index)).collect::<Result<Vec<_>, _>>()?;
        let is_board = |device: &Device| BOARD_NAMES.iter().any(|name| device.description.contains(name));
        Ok(devices.into_iter().filter(is_board).collect())
    }

    fn device(&self, index: u32) -> Result<Device, DriverError> {
        let (mut flags, mut kind, mut id, mut location) = (0, 0, 0, 0);
        let (mut serial, mut description) = ([0_u8; SERIAL], [0_u8; DESCRIPTION]);
        let mut handle: Handle = std::ptr::null_mut();
        // SAFETY: all pointers refer to variables of those types, and the buffers have the size that the library
        // requires.
        check(unsafe {
            (self.0.detail)(
                index,
                &raw mut flags,
                &raw mut kind,
                &raw mut id,
                &raw mut location,
                serial.as_mut_ptr().cast(),
                description.as_mut_ptr().cast(),
                &raw mut handle,
            )
        })?;
        let text = |bytes: &[u8]| {
            let text = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
            String::from_utf8_lossy(text).into_owned()
        };
        let is_opened = flags & OPENED != 0;
        Ok(Device { location, serial: text(&serial), description: text(&description), is_opened })
    }

    /// Lists the boards.
    fn boards(&self) -> Result<Vec<FoundBoard>, WireError> {
        let devices = self.devices().map_err(|error| open_error("usb", error))?;
        let row = |device: Device| FoundBoard {
            address: device.address(),
            holder: device.is_opened.then(|| "another program, perhaps the vendor's server".to_owned()),
            serial: Some(device.serial).filter(|serial| !serial.is_empty()),
            name: device.description,
        };
        Ok(devices.into_iter().map(row).collect())
    }

    /// Opens the link to a board; waits for one that is just starting.
    fn open(&self, wanted: Option<&str>) -> Result<BoardLink, WireError> {
        open_patiently(|| self.find(wanted).and_then(|device| self.claim(&device)))
    }

    fn find(&self, wanted: Option<&str>) -> Result<Device, WireError> {
        choose(self.devices().map_err(|error| open_error("usb", error))?, wanted)
    }

    fn claim(&self, device: &Device) -> Result<BoardLink, WireError> {
        let place = device.address();
        let mut handle: Handle = std::ptr::null_mut();
        // The library takes the number itself instead of a pointer.
        let location = device.location as usize as *mut c_void;
        // SAFETY: when opening by location, the first argument is not dereferenced; the handle is a variable of that
        // type.
        let opened = check(unsafe { (self.0.open)(location, BY_LOCATION, &raw mut handle) });
        opened.map_err(|error| match error {
            DriverError(DEVICE_NOT_OPENED) => {
                let holder = "another program, perhaps the vendor's server".to_owned();
                WireError::Busy { place: place.clone(), holder }
            }
            error => open_error(&place, error),
        })?;
        let chip = Chip(Arc::new(OpenChip { driver: self.clone(), handle: handle as usize }));
        chip.0.prepare().map_err(|error| open_error(&place, error))?;
        Ok(BoardLink::new(place, chip.clone(), chip))
    }
}

fn open_error(place: &str, error: DriverError) -> WireError {
    WireError::Open { place: place.to_owned(), error: error.into() }
}

/// An open chip; it is closed when its last user is dropped.
#[derive(Debug)]
struct OpenChip {
    driver: Driver,
    /// The library's pointer, which is never dereferenced here; functions of the library may be called in any thread.
    handle: usize,
}

impl OpenChip {
    fn handle(&self) -> Handle {
        self.handle as Handle
    }

    /// Sets latency timer, event character and time limits, as the vendor's library does.
    fn prepare(&self) -> Result<(), DriverError> {
        let Functions { set_latency, set_characters, set_timeouts, purge, .. } = &*self.driver.0;
        // SAFETY: the handle is open.
        check(unsafe { set_latency(self.handle(), ftdi::LATENCY) })?;
        // SAFETY: as above.
        check(unsafe { set_characters(self.handle(), b'\n', 1, 0, 0) })?;
        // SAFETY: as above.
        check(unsafe { set_timeouts(self.handle(), STEP, STEP) })?;
        // SAFETY: as above.
        check(unsafe { purge(self.handle(), BOTH) })
    }

    /// The number of bytes that can be read at once.
    fn waiting(&self) -> Result<u32, DriverError> {
        let (mut received, mut sent, mut event) = (0, 0, 0);
        // SAFETY: the handle is open, and the pointers refer to numbers of that type.
        let result = unsafe {
            (self.driver.0.status)(self.handle(), &raw mut received, &raw mut sent, &raw mut event)
        };
        check(result).map(|()| received)
    }
}

impl Drop for OpenChip {
    fn drop(&mut self) {
        // SAFETY: the handle is open, and nobody uses it any more. A disconnected device needs no closing.
        let _ = unsafe { (self.driver.0.close)(self.handle()) };
    }
}

/// The data of a chip; the library has removed the status bytes of packets.
#[derive(Clone, Debug)]
struct Chip(Arc<OpenChip>);

impl Read for Chip {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let waiting = self.0.waiting()?;
        if waiting == 0 {
            std::thread::sleep(PAUSE);
            return Err(io::ErrorKind::TimedOut.into());
        }
        let wanted = waiting.min(u32::try_from(buffer.len()).unwrap_or(u32::MAX));
        let mut count = 0;
        // SAFETY: the handle is open, and the buffer has room for that many bytes.
        let result = unsafe {
            (self.0.driver.0.read)(self.0.handle(), buffer.as_mut_ptr().cast(), wanted, &raw mut count)
        };
        check(result)?;
        if count == 0 { Err(io::ErrorKind::TimedOut.into()) } else { Ok(count as usize) }
    }
}

impl Write for Chip {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut count = 0;
        let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        // SAFETY: the handle is open; the library reads that many bytes and modifies none.
        let result = unsafe {
            (self.0.driver.0.write)(self.0.handle(), bytes.as_ptr().cast_mut().cast(), length, &raw mut count)
        };
        check(result)?;
        // The caller tries again with the same bytes.
        if count == 0 { Err(io::ErrorKind::TimedOut.into()) } else { Ok(count as usize) }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::env;
    use std::fs;
    use std::net::TcpListener;
    use std::process::Command;
    use std::thread;

    use super::*;
    use crate::client::Client;

    /// A driver with one chip that is a connection to a port, built from `ftd2xx.c`.
    fn driver() -> Driver {
        let folder = env::temp_dir().join(format!("cc67-d2xx-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        let library = folder.join("libftd2xx.so");
        let source = folder.join("ftd2xx.c");
        fs::write(&source, include_str!("ftd2xx.c")).expect("the source is written");
        let built = Command::new("cc").args(["-shared", "-fPIC", "-o"]).arg(&library).arg(source).status();
        assert!(built.expect("a linker for Rust is a compiler of C").success());
        let driver = Driver::load(library.as_os_str()).expect("it has all functions");
        fs::remove_dir_all(folder).expect("it was made");
        driver
    }

    /// A board that answers the abort byte and every line.
    fn serve(listener: &TcpListener) {
        let (mut stream, _) = listener.accept().expect("a client");
        let mut byte = [0];
        while stream.read(&mut byte).is_ok_and(|count| count == 1) {
            let answer: &[u8] = match byte[0] {
                3 => b"\x1bC\r",
                b'\r' => b"KFLOP 4.34 Build 16:07:06 Aug 14 2018\r\n",
                _ => b"",
            };
            stream.write_all(answer).expect("the client reads");
        }
    }

    #[test]
    fn a_board_is_found_and_answers_through_the_library() {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let port = listener.local_addr().expect("its number").port();
        let driver = driver();
        // SAFETY: no other test of this crate reads or sets the environment.
        unsafe { env::set_var("FTD2XX_PORT", port.to_string()) };
        thread::spawn(move || serve(&listener));
        let found = driver.boards().expect("a list");
        let one = FoundBoard {
            address: "usb:00000214".into(),
            name: "KFLOP - Motion Controller".into(),
            serial: Some("KF0001".into()),
            holder: None,
        };
        assert_eq!(found, [one]);
        let missing = driver.open(Some("00000999")).expect_err("there is none");
        assert!(missing.to_string().contains("connected: 00000214"), "{missing}");
        for wanted in [Some("214"), Some("KF0001")] {
            assert!(driver.find(wanted).is_ok(), "{wanted:?}");
        }
        let link = driver.open(None).expect("it opens");
        let busy = driver.open(None).expect_err("it is open");
        assert!(busy.to_string().contains("in use by another program"), "{busy}");
        let client = Client::over(link).expect("it answers");
        assert_eq!(client.version(), "KFLOP 4.34 Build 16:07:06 Aug 14 2018");
        drop(client);
        assert!(driver.boards().expect("a list").iter().all(|board| board.holder.is_none()), "it is closed");
    }
}
