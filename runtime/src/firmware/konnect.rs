//! Konnect option boards: not modelled yet.

use kmotiondef::GuestAddr;
use vm::firmware::Caller;
use vm::trap::TrapKind;

use super::not_modelled;
use crate::kernel::Kernel;

pub(crate) fn init_aux(_: &mut Kernel, _: &mut Caller<'_>) -> Result<(), TrapKind> {
    not_modelled("InitAux")
}

pub(crate) fn add_konnect(
    _: &mut Kernel,
    _: &mut Caller<'_>,
    _: i32,
    _: GuestAddr,
    _: GuestAddr,
) -> Result<(), TrapKind> {
    not_modelled("AddKonnect")
}

pub(crate) fn add_konnect_aux0(
    _: &mut Kernel,
    _: &mut Caller<'_>,
    _: i32,
    _: GuestAddr,
    _: GuestAddr,
) -> Result<(), TrapKind> {
    not_modelled("AddKonnect_Aux0")
}
