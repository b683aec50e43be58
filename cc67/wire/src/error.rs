//! Errors of the link, each with the location of the board and a remedy.

use std::io;

use kmotiondef::ThreadId;

/// The udev rule that gives all users of a Linux system access to the board.
pub(crate) const UDEV_RULE: &str =
    r#"SUBSYSTEM=="usb", ATTRS{idVendor}=="0403", ATTRS{idProduct}=="f231", MODE="0666""#;

/// A request to the board that failed.
#[derive(Debug, thiserror::Error)]
pub enum WireError {
    /// No board is connected to USB.
    #[error("no board on USB: looked for devices 0403:f231 and 0403:f230; is it plugged in and powered?")]
    NoBoard,
    /// There is no board at the requested location.
    #[error("no board at usb:{wanted}; connected: {present}")]
    NotThere {
        /// The location that was requested.
        wanted: String,
        /// The connected boards.
        present: String,
    },
    /// Several boards are connected.
    #[error("several boards are connected: {0}; choose one, such as --on usb:LOCATION or --on kogna:SERIAL")]
    SeveralBoards(String),
    /// No Kogna was found.
    #[error(
        "no Kogna{serial} answers in the networks of this computer; found: {present}; `--on tcp:HOST` needs no search"
    )]
    NoKogna {
        /// The requested serial number, as text; may be empty.
        serial: String,
        /// The controllers that answered.
        present: String,
    },
    /// The networks cannot be searched.
    #[error(
        "the networks cannot be searched for a Kogna: {0} (answers come to UDP port 25001, which the vendor's server uses, too); `--on tcp:HOST` needs no search"
    )]
    KognaSearch(io::Error),
    /// The user has no permission to open the device.
    #[error(
        "{place}: no permission. On Linux, put this line into /etc/udev/rules.d/70-kflop.rules, then unplug and plug the board: {UDEV_RULE}"
    )]
    NoPermission {
        /// The board.
        place: String,
    },
    /// The user has no permission to open the serial port.
    #[error(
        "{place}: no permission. On Linux, members of the group `dialout` may open serial ports: sudo usermod -aG dialout $USER, then log in again"
    )]
    NoSerialPermission {
        /// The board.
        place: String,
    },
    /// Another program uses the board.
    #[error(
        "{place}: in use by {holder}; end it, or share the board through the vendor's server with --on server"
    )]
    Busy {
        /// The board.
        place: String,
        /// The program, as far as it is known.
        holder: String,
    },
    /// The link cannot be opened.
    #[error("{place}: {error}")]
    Open {
        /// The board.
        place: String,
        /// The reason.
        error: io::Error,
    },
    /// This kind of link is not available in this build or system.
    #[error("{place}: {reason}")]
    NotBuilt {
        /// The address of the board.
        place: String,
        /// The missing part, and an alternative.
        reason: String,
    },
    /// The link was lost: cable, power, or the program at the other end.
    #[error(
        "{place}: disconnected{during}; the board has lost every program that is not in its flash if its power was off"
    )]
    Disconnected {
        /// The address of the board.
        place: String,
        /// A phrase that names the operation; may be empty.
        during: String,
    },
    /// The board does not answer the abort byte.
    #[error(
        "{place}: the board does not answer (5 attempts of 1 s); if it has just been switched on, wait 3 s, else unplug it and plug it in again"
    )]
    Silent {
        /// The board.
        place: String,
    },
    /// A command was not answered in time.
    #[error("{place}: no answer to `{command}` within {seconds} s")]
    NoAnswer {
        /// The board.
        place: String,
        /// The command.
        command: String,
        /// The time limit.
        seconds: f64,
    },
    /// The board rejects a command.
    #[error("the board refuses `{command}`: {message}")]
    Refused {
        /// The command.
        command: String,
        /// The board's message.
        message: String,
    },
    /// A reply in an unexpected form.
    #[error("{place}: unexpected answer to `{command}`: {answer}")]
    Unexpected {
        /// The board.
        place: String,
        /// The command.
        command: String,
        /// The reply.
        answer: String,
    },
    /// The program was linked for another firmware.
    #[error(
        "the board runs another firmware than the program is linked for\n  board:   {board}\n  program: {program}\nlink with the firmware file of the board (--firmware FILE); --force loads it all the same, and its calls may then jump anywhere"
    )]
    WrongFirmware {
        /// The version of the board.
        board: String,
        /// The version for which the program was linked.
        program: String,
    },
    /// The image was linked for the space of another thread.
    #[error(
        "the image is not for thread {thread}: it has bytes at {address:#010x}, outside {start:#010x} to {end:#010x}"
    )]
    WrongSpace {
        /// The thread.
        thread: ThreadId,
        /// An address of the image outside the space.
        address: u32,
        /// The beginning of its space.
        start: u32,
        /// The last address of its space.
        end: u32,
    },
    /// A thread did not stop.
    #[error("thread {0} does not stop: nothing was loaded")]
    DoesNotStop(ThreadId),
    /// A load did not arrive completely.
    #[error(
        "the program was not loaded into thread {thread}: {reason}. The bytes from {start:#010x} to {end:#010x} are undefined; thread {thread} cannot be started until a load succeeds"
    )]
    LoadFailed {
        /// The thread.
        thread: ThreadId,
        /// The first doubtful address.
        start: u32,
        /// The address after the last doubtful one.
        end: u32,
        /// The reason.
        reason: String,
    },
    /// The board restarted during a request.
    #[error("{place}: the board restarted; the programs that it had are lost unless they are in its flash")]
    Restarted {
        /// The board.
        place: String,
    },
    /// Another program holds the token of the shared board.
    #[error("{place}: another program has used the board for {seconds} s (the server's token is taken)")]
    InUse {
        /// The board.
        place: String,
        /// The waiting time in seconds.
        seconds: f64,
    },
    /// The board is busy with the request of another view.
    #[error("the board is busy with another request since {0} s")]
    Waiting(f64),
}

impl WireError {
    /// Returns whether the link is lost, so that only reconnecting helps.
    #[must_use]
    pub const fn is_disconnected(&self) -> bool {
        matches!(self, Self::Disconnected { .. } | Self::Restarted { .. })
    }
}
