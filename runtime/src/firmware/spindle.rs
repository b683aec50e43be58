//! Spindle measurement and threading: not modelled yet.

use vm::firmware::Caller;
use vm::trap::TrapKind;

use super::not_modelled;
use crate::kernel::Kernel;

pub(crate) fn configure_spindle(
    _: &mut Kernel,
    _: &mut Caller<'_>,
    _: i32,
    _: i32,
    _: f32,
    _: f32,
    _: f32,
) -> Result<(), TrapKind> {
    not_modelled("ConfigureSpindle")
}

pub(crate) fn trig_threading(_: &mut Kernel, _: &mut Caller<'_>, _: f32) -> Result<(), TrapKind> {
    not_modelled("TrigThreading")
}
