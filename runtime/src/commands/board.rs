//! The board as a whole: version, restart, flash, and the link from which it takes commands.

use kmotiondef::variables::DO_RS232_CMDS;

use super::arguments::Values;
use super::session::{Answer, Session};
use crate::firmware::serial;
use crate::out::{Message, Request};
use crate::views::TypedAccess;

/// The board's reply once flash is written (host-protocol.md section 9).
const FLASH_COMPLETE: &str = "Program Flash Image Complete";
/// The board's message once it has read back the data written by `Flash` (dsp-board.md section 2.4).
const VERIFIED: &str = "Verify Complete";
/// The UART's clock; 16 of its periods make the shortest bit.
const UART_CLOCK: i32 = 16_666_666 / 16;
/// The baud rates that the board accepts.
const RATES: [i32; 5] = [9600, 19_200, 38_400, 57_600, 115_200];

pub(super) fn version(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    session.parts.level.board().version.to_owned().into()
}

/// Prints the rest of the command as a console line; without a rest, the text that an earlier command has left in the
/// buffer.
pub(super) fn echo(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    Answer::Console(session.rest.to_vec())
}

pub(super) fn reboot(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    session.parts.out.ask(Request::Reboot);
    Answer::Nothing
}

pub(super) fn flash(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    session.parts.out.ask(Request::Flash);
    if session.memory().map().flash.is_none() {
        return Answer::Nothing;
    }
    Answer::LineAndConsole(FLASH_COMPLETE, VERIFIED)
}

pub(super) fn clear_flash_image(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    session.parts.out.remark(session.context.now, Message::NoFirmwareToReplace {});
    Answer::Nothing
}

/// Takes a new firmware and ignores it; the answer is the same as with a complete image.
pub(super) fn program_flash_image(_: &mut Session<'_, '_>, _: &Values) -> Answer {
    FLASH_COMPLETE.to_owned().into()
}

/// Sends replies to the PC again.
pub(super) fn usb(session: &mut Session<'_, '_>, _: &Values) -> Answer {
    session.memory().set(DO_RS232_CMDS, 0);
    Answer::Nothing
}

/// Takes commands from the UART, and sends replies there.
pub(super) fn rs232(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let rate = values.integer(0);
    if !RATES.contains(&rate) {
        return Answer::Refused("Invalid Baud rate");
    }
    let divisor = UART_CLOCK / rate - 1;
    session.call(|parts, caller| serial::connect(parts, caller, divisor));
    Answer::Nothing
}
