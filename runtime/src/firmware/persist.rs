//! Flash memory: not modelled yet.

use kmotiondef::GuestAddr;
use vm::firmware::Caller;
use vm::trap::TrapKind;

use super::not_modelled;
use crate::kernel::Kernel;

pub(crate) fn program_flash(
    _: &mut Kernel,
    _: &mut Caller<'_>,
    _: GuestAddr,
    _: i32,
    _: GuestAddr,
    _: GuestAddr,
) -> Result<i32, TrapKind> {
    not_modelled("ProgramFlash")
}

pub(crate) fn program_flash_no_messages(
    _: &mut Kernel,
    _: &mut Caller<'_>,
    _: GuestAddr,
    _: i32,
    _: GuestAddr,
) -> Result<i32, TrapKind> {
    not_modelled("ProgramFlashNoMessages")
}

pub(crate) fn set_flash_bank(_: &mut Kernel, _: &mut Caller<'_>, _: GuestAddr) -> Result<(), TrapKind> {
    not_modelled("SetFlashBank")
}
