//! Clients: creating a board, sharing it, closing it.

use std::ffi::{c_char, c_int};
use std::path::{Path, PathBuf};
use std::ptr;

use cc67_host::runtime::{Config, Directory, MachineFile};
use cc67_host::{Board, BootedFirmware, Options, fill};

use crate::border::{buffer, guarded_or, optional_text};
use crate::handle::{BoardNumber, Client, board, check};

/// Makes a board at power-up, and its first client. `files` is the folder of the files that programs open on the PC, or
/// null for none; `machine` is a machine file, what is connected to the board, or null for nothing. Null on failure,
/// with the reason in `message`, which may be null.
///
/// # Safety
/// Texts end with a 0; `message` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_open(
    files: *const c_char,
    machine: *const c_char,
    message: *mut c_char,
    size: usize,
) -> *mut Client {
    guarded_or(ptr::null_mut(), || {
        // SAFETY: the caller vouches for the buffer.
        let message = unsafe { buffer(message, size) };
        // SAFETY: the caller vouches for the text.
        let files = unsafe { optional_text(files) };
        // SAFETY: the caller vouches for the text.
        let machine = unsafe { optional_text(machine) };
        let (Ok(files), Ok(machine)) = (files, machine) else {
            fill(message, "a name is not UTF-8");
            return ptr::null_mut();
        };
        opened(open(files.map(PathBuf::from), machine.map(Path::new)), message)
    })
}

/// Makes a board that runs your own firmware file, and its first client: programs are compiled for the processor, and
/// the firmware answers. `firmware` is the name of the file; the other arguments and the result are those of
/// `cc67_open`.
///
/// # Safety
/// Texts end with a 0; `message` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_open_firmware(
    firmware: *const c_char,
    files: *const c_char,
    machine: *const c_char,
    message: *mut c_char,
    size: usize,
) -> *mut Client {
    guarded_or(ptr::null_mut(), || {
        // SAFETY: the caller vouches for the buffer.
        let message = unsafe { buffer(message, size) };
        // SAFETY: the caller vouches for the text.
        let firmware = unsafe { optional_text(firmware) };
        // SAFETY: the caller vouches for the text.
        let files = unsafe { optional_text(files) };
        // SAFETY: the caller vouches for the text.
        let machine = unsafe { optional_text(machine) };
        let (Ok(firmware), Ok(files), Ok(machine)) = (firmware, files, machine) else {
            fill(message, "a name is not UTF-8");
            return ptr::null_mut();
        };
        let Some(firmware) = firmware else {
            fill(message, "the firmware file has no name");
            return ptr::null_mut();
        };
        opened(boot(Path::new(firmware), files.map(PathBuf::from), machine.map(Path::new)), message)
    })
}

/// Connects to a controller, and makes its first client: programs are compiled for its processor and its firmware.
/// `address` is `usb`, `usb:LOCATION`, `serial:PATH`, `server`, `kogna` or `tcp:HOST:PORT`, as with `cc67 run --on`;
/// `files` is that of `cc67_open`. Connecting starts nothing, and programs that run already continue. Time passes by
/// itself: cc67_run_for and cc67_run_until wait. Nothing of cc67 has been tried on a controller yet, only on the released
/// firmware in emulation: switch the drives off for the first trials. Null on failure, with the reason in `message`.
///
/// # Safety
/// Texts end with a 0; `message` has room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_open_controller(
    address: *const c_char,
    files: *const c_char,
    message: *mut c_char,
    size: usize,
) -> *mut Client {
    guarded_or(ptr::null_mut(), || {
        // SAFETY: the caller vouches for the buffer.
        let message = unsafe { buffer(message, size) };
        // SAFETY: the caller vouches for the text.
        let address = unsafe { optional_text(address) };
        // SAFETY: the caller vouches for the text.
        let files = unsafe { optional_text(files) };
        let (Ok(address), Ok(files)) = (address, files) else {
            fill(message, "a name is not UTF-8");
            return ptr::null_mut();
        };
        let Some(address) = address else {
            fill(message, "the controller has no address");
            return ptr::null_mut();
        };
        opened(connect(address, files.map(PathBuf::from)), message)
    })
}

/// A client as C receives it; on failure the reason is written to the buffer.
fn opened(client: Result<Client, String>, message: &mut [u8]) -> *mut Client {
    match client {
        Ok(client) => {
            fill(message, "");
            client.into_pointer()
        }
        Err(error) => {
            fill(message, &error);
            ptr::null_mut()
        }
    }
}

fn open(files: Option<PathBuf>, machine: Option<&Path>) -> Result<Client, String> {
    let board = Board::with(config(files, machine)?);
    Ok(Client { board, options: Options::default(), number: BoardNumber::new() })
}

fn boot(firmware: &Path, files: Option<PathBuf>, machine: Option<&Path>) -> Result<Client, String> {
    let firmware = BootedFirmware::open(firmware).map_err(|error| error.to_string())?;
    let board = Board::booted(&firmware, config(files, machine)?).map_err(|error| error.to_string())?;
    let options = board.options();
    Ok(Client { board, options, number: BoardNumber::new() })
}

#[cfg(feature = "controller")]
fn connect(address: &str, files: Option<PathBuf>) -> Result<Client, String> {
    use cc67_controller::{Address, ControllerLink, LoadTerms};
    use cc67_host::Setup;

    let address: Address = address.parse().map_err(|error| format!("{error}"))?;
    let link = ControllerLink::open(&address).map_err(|error| error.to_string())?;
    let options = link.options();
    let setup = Setup { config: config(files, None)?, options: options.clone(), ..Setup::default() };
    let session = link.session(setup, LoadTerms::default(), |_, _| ()).map_err(|error| error.to_string())?;
    Ok(Client { board: Board::from_session(session.on_any()), options, number: BoardNumber::new() })
}

#[cfg(not(feature = "controller"))]
fn connect(address: &str, _: Option<PathBuf>) -> Result<Client, String> {
    Err(format!("{address}: this library is built without controllers (feature `controller`)"))
}

/// The configuration of a board: the folder for its files and its machine file.
fn config(files: Option<PathBuf>, machine: Option<&Path>) -> Result<Config, String> {
    let mut config = Config::default();
    if let Some(folder) = files {
        config.files = Box::new(Directory::new(folder));
    }
    if let Some(path) = machine {
        let text = std::fs::read_to_string(path)
            .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        config.machine_file = MachineFile::parse(&text)
            .map_err(|error| format!("{}:{}:{}: {error}", path.display(), error.line, error.column))?;
        config.machine_file.set_name(path);
    }
    Ok(config)
}

/// Makes one more client of the same board, for another thread or another part of the program. Null on failure, and in
/// a call-back of the board.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_another_client(client: *mut Client) -> *mut Client {
    guarded_or(ptr::null_mut(), || {
        // SAFETY: the caller vouches for the client.
        if unsafe { check(client) }.is_err() {
            return ptr::null_mut();
        }
        // SAFETY: the caller vouches for the client, which is not null.
        let Client { board, number, .. } = unsafe { &mut *client };
        Client { board: board.another_client(), options: board.options(), number: *number }.into_pointer()
    })
}

/// Closes a client. It loses the token if it holds it, and its call-back is taken out; the last client of a board
/// takes the board with it. Null is ignored, and so is any client of a board in its call-back.
///
/// # Safety
/// `client` is open, and is not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_close(client: *mut Client) {
    guarded_or((), || {
        // SAFETY: the caller vouches for the client.
        if unsafe { check(client) }.is_ok() {
            // SAFETY: the pointer came from a box, as the caller vouches, and nobody uses it any more.
            drop(unsafe { Box::from_raw(client) });
        }
    });
}

/// Writes the identifiers of the boards that are connected to `list`, as many as fit, and returns how many there are;
/// -1 if an argument is wrong, or in a call-back. `list` may be null if `capacity` is 0.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile; `list` has room for `capacity` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_list_locations(
    client: *mut Client,
    list: *mut c_int,
    capacity: usize,
) -> c_int {
    guarded_or(-1, || {
        // SAFETY: the caller vouches for the client.
        let Ok(board) = (unsafe { board(client) }) else { return -1 };
        let found = board.list_locations();
        for (index, location) in found.iter().take(capacity).enumerate() {
            // SAFETY: the index is below the capacity that the caller vouches for.
            let place = unsafe { list.wrapping_add(index).as_mut() };
            let Some(place) = place else { return -1 };
            *place = *location;
        }
        c_int::try_from(found.len()).unwrap_or(c_int::MAX)
    })
}

/// The generation of the board's firmware: 2, as of every board but the oldest; -1 if the client is null.
///
/// # Safety
/// `client` is open, and no other call uses it meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cc67_firmware_version(client: *mut Client) -> c_int {
    // SAFETY: the caller vouches for the client.
    guarded_or(-1, || unsafe { board(client) }.map_or(-1, |board| board.firmware_version()))
}
