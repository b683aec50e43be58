//! Registers of the SnapAmp option board: not modelled yet.

use vm::firmware::Caller;
use vm::trap::TrapKind;

use super::not_modelled;
use crate::kernel::Kernel;

pub(crate) fn write_snap_amp(_: &mut Kernel, _: &mut Caller<'_>, _: i32, _: i32) -> Result<(), TrapKind> {
    not_modelled("WriteSnapAmp")
}

pub(crate) fn read_snap_amp(_: &mut Kernel, _: &mut Caller<'_>, _: i32) -> Result<i32, TrapKind> {
    not_modelled("ReadSnapAmp")
}
