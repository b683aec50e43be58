//! The UART: not modelled yet.

use vm::firmware::Caller;
use vm::trap::TrapKind;

use super::not_modelled;
use crate::kernel::Kernel;

pub(crate) fn init_rs232(_: &mut Kernel, _: &mut Caller<'_>, _: i32) -> Result<(), TrapKind> {
    not_modelled("InitRS232")
}

pub(crate) fn enable_rs232_cmds(_: &mut Kernel, _: &mut Caller<'_>, _: i32) -> Result<(), TrapKind> {
    not_modelled("EnableRS232Cmds")
}

pub(crate) fn rs232_get_char(_: &mut Kernel, _: &mut Caller<'_>) -> Result<i32, TrapKind> {
    not_modelled("RS232_GetChar")
}

pub(crate) fn rs232_put_char(_: &mut Kernel, _: &mut Caller<'_>, _: u8) -> Result<(), TrapKind> {
    not_modelled("RS232_PutChar")
}
