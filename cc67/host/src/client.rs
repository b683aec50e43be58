//! A client of the board, and the token that gives it exclusive use of the board.

use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use kmotiondef::ThreadId;
use runtime::{Config, Event};

use crate::session::{EXCHANGE, ticks};
use crate::state::{State, Status};
use crate::{AnyTarget, BootedFirmware, Capability, HostError, Session, Setup, UserProgram, fill};
use compiler::Options;

/// Seconds that [`Board::write_line_read_line`] waits for its reply.
const REPLY_SECONDS: f64 = 3.0;
/// Seconds that [`Board::check_for_ready`] waits for a line.
const READY_SECONDS: f64 = 0.1;
/// The time for which the vendor's library waits for the token: twice 10⁶ ms.
const LONGEST_WAIT: Duration = Duration::from_secs(2000);
/// The identifier of the simulated board.
const LOCATION: i32 = 1;

/// The result of a request for the token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Lock {
    /// This client has exclusive use of the board.
    Locked = 0,
    /// Another client has the token.
    InUse = 1,
    /// There is no connection, and none could be made.
    NotConnected = 2,
}

/// The board's answer to the question whether it is ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Readiness {
    /// There was no message.
    NoData = 0,
    /// Part of a line came, without `Ready`.
    Partial = 1,
    /// `Ready` came.
    Ready = 2,
    /// `Ready` came after an error.
    ReadyAfterError = 3,
}

/// The state that all clients of a board share.
#[derive(Debug)]
struct Shared {
    state: Mutex<State>,
    /// The token was released.
    released: Condvar,
}

///
/// A client of a simulated board; [`another_client`](Self::another_client) creates further clients of the same board.
/// When a client is dropped, its token is released and its console call-back is removed.
#[derive(Debug)]
pub struct Board {
    shared: Arc<Shared>,
    number: u64,
    has_token: bool,
}

impl Default for Board {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        self.state().drop_callback(self.number);
        self.release_token();
    }
}

impl Board {
    /// Creates a board at power-up, without files on the PC.
    #[must_use]
    pub fn new() -> Self {
        Self::with(Config::default())
    }

    /// Creates a board with these settings.
    ///
    /// ```
    /// use cc67_host::Board;
    /// use runtime::{Config, Directory};
    ///
    /// let files = std::env::temp_dir();
    /// let board = Board::with(Config { files: Box::new(Directory::new(files)), ..Config::default() });
    /// assert_eq!(board.list_locations().len(), 1);
    /// ```
    #[must_use]
    pub fn with(config: Config) -> Self {
        let session = Setup { config, ..Setup::default() }.session_on_any(None);
        Self::from_session(session.expect("nothing is loaded that could be refused"))
    }

    /// Creates a board that runs a firmware file, with these settings; programs are compiled for that firmware.
    ///
    /// # Errors
    /// The flash belongs to another firmware, or this firmware cannot be connected to the hardware in the settings.
    pub fn booted(firmware: &BootedFirmware, config: Config) -> Result<Self, HostError> {
        let options = firmware.options(Options::default());
        let setup = Setup { config, options, ..Setup::default() };
        Ok(Self::from_session(setup.session_on_any(Some(firmware))?))
    }

    /// Returns the first client of a board that is already under control. The actions of clients are not recorded, as
    /// they may go on forever.
    #[must_use]
    pub fn from_session(session: Session<AnyTarget>) -> Self {
        let mut state = State::new(session);
        let number = state.number();
        let shared = Shared { state: Mutex::new(state), released: Condvar::new() };
        Self { shared: Arc::new(shared), number, has_token: false }
    }

    /// Returns a further client of the same board.
    ///
    /// ```
    /// use cc67_host::{Board, Lock};
    ///
    /// let mut first = Board::new();
    /// let mut second = first.another_client();
    /// assert_eq!(first.kmotion_lock(), Lock::Locked);
    /// assert_eq!(second.kmotion_lock(), Lock::InUse);
    /// drop(first);
    /// assert_eq!(second.kmotion_lock(), Lock::Locked);
    /// ```
    #[must_use]
    pub fn another_client(&self) -> Self {
        let number = self.state().number();
        Self { shared: Arc::clone(&self.shared), number, has_token: false }
    }

    /// Returns the options with which programs are compiled.
    #[must_use]
    pub fn options(&self) -> Options {
        self.state().session.options().clone()
    }

    /// Sets the options for programs compiled from now on: include directories, macros, firmware.
    pub fn set_options(&mut self, options: Options) {
        self.state().session.set_options(options);
    }

    /// Compiles a source, links it for a thread and loads it there, without starting it.
    ///
    /// # Errors
    /// The program cannot be compiled or loaded; the previous program remains in the thread, and continues if it runs.
    ///
    /// ```
    /// use cc67_host::Board;
    ///
    /// let file = std::env::temp_dir().join("cc67-example-load.c");
    /// std::fs::write(&file, "#include \"KMotionDef.h\"\nmain() { persist.UserData[7] = 11; }")?;
    /// let mut board = Board::new();
    /// board.compile_and_load_coff(&file, 1)?;
    /// board.write_line("Execute1")?;
    /// board.run_for(0.01);
    /// assert_eq!(board.write_line_read_line("GetPersistDec 7")?, "11");
    /// # std::fs::remove_file(&file)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn compile_and_load_coff(&mut self, file: &Path, thread: i32) -> Result<(), HostError> {
        let id = ThreadId::new(thread).ok_or(HostError::Thread(thread))?;
        self.state().connected()?;
        let options = self.state().session.options().clone();
        // Other clients continue while this one compiles.
        let program = UserProgram::compile(file, id, &options)?;
        self.state().session.load(program)
    }

    /// Does the same as [`compile_and_load_coff`](Self::compile_and_load_coff) for callers with a buffer: returns 0, or
    /// another number with the message in the buffer. The message is cut to fit and always ends with a 0.
    ///
    /// ```
    /// use cc67_host::Board;
    ///
    /// let mut message = [0; 80];
    /// let result = Board::new().compile_and_load_coff_with_message("nosuch.c".as_ref(), 1, &mut message);
    /// assert_ne!(result, 0);
    /// assert!(message.starts_with(b"cannot read nosuch.c"));
    /// ```
    pub fn compile_and_load_coff_with_message(
        &mut self,
        file: &Path,
        thread: i32,
        message: &mut [u8],
    ) -> i32 {
        match self.compile_and_load_coff(file, thread) {
            Ok(()) => {
                fill(message, "");
                0
            }
            Err(error) => {
                fill(message, &error.to_string());
                1
            }
        }
    }

    /// Loads an image, as `cc67 build` writes it, into a thread.
    ///
    /// # Errors
    /// The image cannot be loaded; the previous program remains in the thread, and continues if it runs.
    ///
    /// ```
    /// use cc67_host::Board;
    ///
    /// assert!(Board::new().load_coff(1, "nosuch.out".as_ref()).is_err());
    /// ```
    pub fn load_coff(&mut self, thread: i32, file: &Path) -> Result<(), HostError> {
        let id = ThreadId::new(thread).ok_or(HostError::Thread(thread))?;
        let program = UserProgram::from_image(file, id)?;
        let mut state = self.state();
        state.connected()?;
        state.session.load(program)
    }

    /// Sends a line of script commands without waiting for a reply.
    ///
    /// # Errors
    /// [`HostError::NotConnected`].
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// board.write_line("EnableAxis0;Jog0=1000")?;
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn write_line(&mut self, line: &str) -> Result<(), HostError> {
        let mut state = self.state();
        state.connected()?;
        state.send_line(&[b"\x1b\x01", line.as_bytes(), b"\r"].concat());
        Ok(())
    }

    /// Sends a line that the board echoes; the board then replies `Ready`.
    ///
    /// # Errors
    /// [`HostError::NotConnected`]; [`HostError::Unsupported`] for a connected controller.
    ///
    /// ```
    /// use cc67_host::{Board, Readiness};
    ///
    /// let mut board = Board::new();
    /// board.write_line_with_echo("Version")?;
    /// assert_eq!(board.check_for_ready()?, Readiness::Ready);
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn write_line_with_echo(&mut self, line: &str) -> Result<(), HostError> {
        let mut state = self.state();
        state.connected()?;
        state.session.require(Capability::Echoes)?;
        state.send_line(&[line.as_bytes(), b"\r"].concat());
        Ok(())
    }

    /// Returns the next line of a reply, with its line end, if it comes within this many milliseconds of board time.
    ///
    /// # Errors
    /// [`HostError::Timeout`], [`HostError::NotConnected`].
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// board.write_line("GetGatherHex 0 24")?;
    /// for _ in 0..3 {
    ///     assert_eq!(board.read_line_timeout(100)?.split_whitespace().count(), 8);
    /// }
    /// assert!(board.read_line_timeout(100).is_err());
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn read_line_timeout(&mut self, milliseconds: u32) -> Result<String, HostError> {
        let mut state = self.state();
        state.connected()?;
        state.read_line(ticks(f64::from(milliseconds) / 1000.0)).ok_or(HostError::Timeout)
    }

    /// Sends a line and returns a line of its reply, without the line end; first waits for the token.
    ///
    /// # Errors
    /// [`HostError::Timeout`] if there is no reply within 3 s, [`HostError::NotConnected`].
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// assert_eq!(board.write_line_read_line("Version")?, "KFLOP 4.34 Build 16:07:06 Aug 14 2018");
    /// assert!(board.write_line_read_line("Nonsense").is_err());
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn write_line_read_line(&mut self, line: &str) -> Result<String, HostError> {
        let had_token = self.has_token;
        if !had_token && self.wait_token(None) != Lock::Locked {
            return Err(HostError::InUse);
        }
        let reply = self.exchange(line);
        if !had_token {
            self.release_token();
        }
        reply
    }

    fn exchange(&mut self, line: &str) -> Result<String, HostError> {
        let mut state = self.state();
        state.connected()?;
        let begin = state.session.tick().get();
        state.send(&[b"\x1b\x01", line.as_bytes(), b"\r"].concat());
        let reply = state.read_line(ticks(REPLY_SECONDS)).ok_or(HostError::Timeout)?;
        let spent = state.session.tick().get() - begin;
        state.advance(EXCHANGE.saturating_sub(spent), &mut |_| false);
        Ok(reply.trim_end_matches(['\r', '\n']).to_owned())
    }

    /// Requests the token once; connects first if necessary.
    ///
    /// ```
    /// use cc67_host::{Board, Lock};
    ///
    /// let mut board = Board::new();
    /// assert_eq!(board.kmotion_lock(), Lock::Locked);
    /// board.release_token();
    /// ```
    pub fn kmotion_lock(&mut self) -> Lock {
        let mut state = self.state();
        if !state.is_connected {
            state.connect();
        }
        if state.is_lost() {
            return Lock::NotConnected;
        }
        if !self.has_token && state.is_locked {
            return Lock::InUse;
        }
        state.is_locked = true;
        drop(state);
        self.has_token = true;
        Lock::Locked
    }

    /// Waits until another client releases the token: at most `limit`, or 2000 s, as the vendor's library does.
    ///
    /// ```
    /// use std::time::Duration;
    ///
    /// use cc67_host::{Board, Lock};
    ///
    /// let mut first = Board::new();
    /// let mut second = first.another_client();
    /// assert_eq!(first.wait_token(None), Lock::Locked);
    /// assert_eq!(second.wait_token(Some(Duration::from_millis(20))), Lock::InUse);
    /// first.release_token();
    /// assert_eq!(second.wait_token(None), Lock::Locked);
    /// ```
    pub fn wait_token(&mut self, limit: Option<Duration>) -> Lock {
        let lock = self.kmotion_lock();
        if lock != Lock::InUse {
            return lock;
        }
        let taken = |state: &mut State| state.is_locked;
        let limit = limit.unwrap_or(LONGEST_WAIT);
        let waited = self.shared.released.wait_timeout_while(self.state(), limit, taken);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        if state.is_locked {
            return Lock::InUse;
        }
        state.is_locked = true;
        drop(state);
        self.has_token = true;
        Lock::Locked
    }

    /// Releases the token; has no effect without it.
    pub fn release_token(&mut self) {
        if std::mem::take(&mut self.has_token) {
            self.state().is_locked = false;
            self.shared.released.notify_one();
        }
    }

    /// Closes the connection, as after a failure; [`kmotion_lock`](Self::kmotion_lock) connects again.
    ///
    /// ```
    /// use cc67_host::{Board, HostError, Lock};
    ///
    /// let mut board = Board::new();
    /// board.failed();
    /// assert!(matches!(board.write_line("Zero0"), Err(HostError::NotConnected)));
    /// assert_eq!(board.kmotion_lock(), Lock::Locked);
    /// assert!(board.write_line("Zero0").is_ok());
    /// ```
    pub fn failed(&mut self) {
        self.state().is_connected = false;
    }

    /// Closes the connection.
    pub fn disconnect(&mut self) {
        self.failed();
    }

    /// Takes at most one console line: passes it to the call-back, or returns it if there is none. Does nothing while
    /// another client has the token.
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// board.write_line("Echo hello")?;
    /// assert_eq!(board.service_console(), Some("HELLO".to_owned()));
    /// assert_eq!(board.service_console(), None);
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn service_console(&mut self) -> Option<String> {
        let mut state = self.state();
        if !state.is_connected || state.is_locked && !self.has_token {
            return None;
        }
        state.advance(EXCHANGE, &mut |state| state.has_console());
        state.take_console()
    }

    /// Passes console lines to a function as they come, during any call. The board is in use meanwhile: the function
    /// must not call any of its clients.
    ///
    /// ```
    /// use std::sync::mpsc;
    ///
    /// let mut board = cc67_host::Board::new();
    /// let (sender, lines) = mpsc::channel();
    /// board.set_console_callback(move |line| sender.send(line.to_owned()).expect("it is awaited"));
    /// board.write_line("Echo hello")?;
    /// assert_eq!(lines.try_recv(), Ok("HELLO".to_owned()));
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn set_console_callback(&mut self, callback: impl FnMut(&str) + Send + 'static) {
        self.state().set_callback(self.number, Box::new(callback));
    }

    /// Removes the call-back of this client: console lines wait for [`service_console`](Self::service_console) again.
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// board.set_console_callback(|_| ());
    /// board.drop_console_callback();
    /// board.write_line("Echo hello")?;
    /// assert_eq!(board.service_console(), Some("HELLO".to_owned()));
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn drop_console_callback(&mut self) {
        self.state().drop_callback(self.number);
    }

    /// Reads lines until `Ready` comes, or until no line comes for 0.1 s.
    ///
    /// # Errors
    /// [`HostError::NotConnected`].
    ///
    /// ```
    /// use cc67_host::{Board, Readiness};
    ///
    /// let mut board = Board::new();
    /// assert_eq!(board.check_for_ready()?, Readiness::NoData);
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn check_for_ready(&mut self) -> Result<Readiness, HostError> {
        let mut state = self.state();
        state.connected()?;
        let mut has_error = false;
        while let Some(line) = state.read_line(ticks(READY_SECONDS)) {
            if line.trim_end() == "Ready" {
                return Ok(if has_error { Readiness::ReadyAfterError } else { Readiness::Ready });
            }
            has_error |= line.to_ascii_lowercase().contains("error");
        }
        Ok(if state.has_partial_line() { Readiness::Partial } else { Readiness::NoData })
    }

    /// Returns the status record, as applications poll it.
    ///
    /// # Errors
    /// [`HostError::Timeout`], [`HostError::NotConnected`].
    pub fn get_status(&mut self) -> Result<Status, HostError> {
        let mut state = self.state();
        state.connected()?;
        state.send(b"\x1b\x01GetStatus\r");
        state.read_status().ok_or(HostError::Timeout)
    }

    /// Returns the identifiers of the connected boards: there is one.
    ///
    /// ```
    /// assert_eq!(cc67_host::Board::new().list_locations().len(), 1);
    /// ```
    #[must_use]
    pub fn list_locations(&self) -> Vec<i32> {
        vec![LOCATION]
    }

    /// Returns the generation of the firmware: 2, as for all boards except the oldest.
    #[must_use]
    pub const fn firmware_version(&self) -> i32 {
        2
    }

    /// Lets this many seconds of board time pass.
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// board.write_line("EnableAxis0;Move0=100")?;
    /// board.run_for(1.0);
    /// assert_eq!(board.write_line_read_line("Dest0")?, "100");
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn run_for(&mut self, seconds: f64) {
        self.state().advance(ticks(seconds), &mut |_| false);
    }

    /// Lets board time pass until `is_over` returns true after a tick, at most this many seconds; returns whether it
    /// has.
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// board.write_line("SetPersistDec 100 99")?;
    /// // The built-in PC refuses a request that it does not know.
    /// assert!(board.run_until(0.5, |session| session.user_data(100) == Some(-1)));
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn run_until(
        &mut self,
        seconds: f64,
        mut is_over: impl FnMut(&mut Session<AnyTarget>) -> bool,
    ) -> bool {
        self.state().advance(ticks(seconds), &mut |state| is_over(&mut state.session))
    }

    /// Accesses the session directly, to inspect memory or drive inputs.
    ///
    /// ```
    /// use kmotiondef::Bit;
    ///
    /// let mut board = cc67_host::Board::new();
    /// let bit = Bit::new(136).expect("there are 2048");
    /// board.with_session(|session| session.drive_input(bit, true))?;
    /// assert_eq!(board.write_line_read_line("ReadBit136")?, "1");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_session<R>(&mut self, work: impl FnOnce(&mut Session<AnyTarget>) -> R) -> R {
        work(&mut self.state().session)
    }

    /// Takes the remarks since the last call: traps, remarks, and actions of the PC for programs.
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// board.write_line("Move0=5")?; // the axis is disabled
    /// assert_eq!(board.take_remarks().len(), 1);
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn take_remarks(&mut self) -> Vec<Event> {
        self.state().take_remarks()
    }

    /// Takes the oldest of these remarks as text, as `cc67 run` shows it: a trap with its source line.
    ///
    /// ```
    /// let mut board = cc67_host::Board::new();
    /// board.write_line("Move0=5")?;
    /// assert_eq!(board.take_remark().as_deref(), Some("command: Move: axis 0 is disabled, so nothing moves"));
    /// assert_eq!(board.take_remark(), None);
    /// # Ok::<(), cc67_host::HostError>(())
    /// ```
    pub fn take_remark(&mut self) -> Option<String> {
        self.state().take_remark()
    }

    /// The shared state. A client that panics during a call leaves the board usable for others.
    fn state(&self) -> MutexGuard<'_, State> {
        self.shared.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
