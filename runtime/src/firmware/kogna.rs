//! Functions that only a Kogna has. Source: its header; never compared with a board.
//!
//! The pins of the fast PWM channels and of the SPI port are inputs and outputs; their devices drive nothing. Flash
//! memory, the RS422 port and the primed coordinate system are not simulated: a program that calls them gets a message,
//! and ends.

use kmotiondef::GuestAddr;
use vm::firmware::{Caller, Outcome};

use super::parts::Parts;
use crate::io::bits;
use crate::io::kogna::PinGroup;
use crate::out::Message;

fn set_mode(parts: &mut Parts, group: PinGroup, pin: i32, mode: i32) {
    if let Some(kogna) = &mut parts.io.kogna
        && let Some(held) = usize::try_from(pin).ok().and_then(|pin| kogna.modes(group).get_mut(pin))
    {
        *held = mode;
    }
}

fn mode(parts: &mut Parts, group: PinGroup, pin: i32) -> i32 {
    let modes = parts.io.kogna.as_mut().map(|kogna| kogna.modes(group));
    modes.zip(usize::try_from(pin).ok()).and_then(|(modes, pin)| modes.get(pin).copied()).unwrap_or(0)
}

fn set_direction(parts: &mut Parts, caller: &mut Caller<'_>, group: PinGroup, pin: i32, direction: i32) {
    if let Some(bit) = group.bit(pin) {
        bits::set_direction(&mut parts.io, caller.memory, bit, direction != 0, caller.now());
    }
}

fn direction(parts: &Parts, caller: &Caller<'_>, group: PinGroup, pin: i32) -> i32 {
    group.bit(pin).map_or(0, |bit| i32::from(bits::is_output(&parts.io, caller.memory, bit)))
}

fn write(parts: &mut Parts, caller: &mut Caller<'_>, group: PinGroup, pin: i32, level: bool) {
    if let Some(bit) = group.bit(pin) {
        let now = caller.now();
        parts.lines(now).write(caller.memory, bit, level);
    }
}

fn read(parts: &Parts, caller: &Caller<'_>, group: PinGroup, pin: i32) -> i32 {
    group.bit(pin).map_or(0, |bit| i32::from(bits::bit_state(&parts.io, caller.memory, bit).0))
}

/// Tells that a function is not simulated; the thread ends.
fn end_unsimulated<T>(parts: &mut Parts, caller: &Caller<'_>, function: &'static str) -> Outcome<T> {
    parts.out.diagnose(caller, Message::NotSimulated { function });
    Outcome::End
}

/// The functions of a group of pins, in a module.
macro_rules! pin_functions {
    ($module:ident, $group:ident) => {
        pub(crate) mod $module {
            use vm::firmware::Caller;

            use crate::firmware::parts::Parts;
            use crate::io::kogna::PinGroup;

            pub(crate) fn set_mode(parts: &mut Parts, _: &mut Caller<'_>, pin: i32, to: i32) {
                super::set_mode(parts, PinGroup::$group, pin, to);
            }

            pub(crate) fn get_mode(parts: &mut Parts, _: &mut Caller<'_>, pin: i32) -> i32 {
                super::mode(parts, PinGroup::$group, pin)
            }

            pub(crate) fn set_dir(parts: &mut Parts, caller: &mut Caller<'_>, pin: i32, to: i32) {
                super::set_direction(parts, caller, PinGroup::$group, pin, to);
            }

            pub(crate) fn get_dir(parts: &mut Parts, caller: &mut Caller<'_>, pin: i32) -> i32 {
                super::direction(parts, caller, PinGroup::$group, pin)
            }

            pub(crate) fn set_bit(parts: &mut Parts, caller: &mut Caller<'_>, pin: i32) {
                super::write(parts, caller, PinGroup::$group, pin, true);
            }

            pub(crate) fn clear_bit(parts: &mut Parts, caller: &mut Caller<'_>, pin: i32) {
                super::write(parts, caller, PinGroup::$group, pin, false);
            }

            pub(crate) fn read_bit(parts: &mut Parts, caller: &mut Caller<'_>, pin: i32) -> i32 {
                super::read(parts, caller, PinGroup::$group, pin)
            }
        }
    };
}
pin_functions!(hrpwm, Hrpwm);
pin_functions!(spi, Spi);

#[expect(clippy::too_many_arguments, reason = "as the function has them in C")]
pub(crate) fn define_coord_system_8p(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    _: i32,
    _: i32,
    _: i32,
    _: i32,
    _: i32,
    _: i32,
    _: i32,
    _: i32,
) -> Outcome<()> {
    end_unsimulated(parts, caller, "DefineCoordSystem8P")
}

pub(crate) fn nand_write_blocks(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    _: i32,
    _: GuestAddr,
    _: i32,
) -> Outcome<i32> {
    end_unsimulated(parts, caller, "NandWriteBlocks")
}

pub(crate) fn nand_read_blocks(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    _: i32,
    _: i32,
    _: GuestAddr,
    _: i32,
) -> Outcome<i32> {
    end_unsimulated(parts, caller, "NandReadBlocks")
}

pub(crate) fn enable_rs422_cmds(parts: &mut Parts, caller: &mut Caller<'_>, _: i32) -> Outcome<()> {
    end_unsimulated(parts, caller, "EnableRS422Cmds")
}

pub(crate) fn rs422_set_baud_rate(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    _: i32,
    _: i32,
    _: i32,
    _: i32,
    _: i32,
) -> Outcome<()> {
    end_unsimulated(parts, caller, "RS422_SetBaudRate")
}

pub(crate) fn rs422_get_char(parts: &mut Parts, caller: &mut Caller<'_>) -> Outcome<i32> {
    end_unsimulated(parts, caller, "RS422_GetChar")
}

pub(crate) fn rs422_put_char(parts: &mut Parts, caller: &mut Caller<'_>, _: i32) -> Outcome<()> {
    end_unsimulated(parts, caller, "RS422_PutChar")
}
