//! Settings of an axis, prepared for a tick.
//!
//! The settings are in guest memory, where programs can write them at any time. If only the servo has run since the
//! last tick, they need not be read again: the values derived from them are kept, and recomputed as soon as a thread,
//! the call-back, the PC or the world has run. Builds with debug assertions compare them in every tick.

use kmotiondef::modes::{BacklashMode, InputMode, OutputMode};
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::{AxisId, Field, GuestAddr};
use vm::memory::GuestMemory;

use crate::machine::COUNTS_PER_TICK;
use crate::machine::wiring::Wiring;
use crate::views::AxisView;

/// The source of an axis' position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Input {
    /// Nowhere, or a program writes it.
    #[default]
    None,
    Encoder(Encoder),
    Adc,
    Resolver,
}

/// An encoder that an axis reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Encoder {
    /// Position units of a count.
    pub(crate) gain: f64,
    /// The number of its channel, if that channel exists.
    pub(crate) channel: Option<u32>,
    /// The axis whose load turns it; `None` if it is only turned by hand.
    pub(crate) turned_by: Option<AxisId>,
    /// That axis' position units of a count.
    pub(crate) turned_gain: f64,
    /// True if the input is now turned by hand: the load of that axis no longer turns it.
    pub(crate) is_held: bool,
}

/// A filter's coefficients.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Filter {
    /// True if it passes its input on unchanged, as at power-up; most do.
    pub(crate) is_plain: bool,
    pub(crate) a1: f32,
    pub(crate) a2: f32,
    pub(crate) b0: f32,
    pub(crate) b1: f32,
    pub(crate) b2: f32,
}

/// The compensation's settings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Gains {
    pub(crate) p: f32,
    pub(crate) i: f32,
    pub(crate) d: f32,
    /// True if the derivative gain acts on the error, false if only on the position.
    pub(crate) derives_error: bool,
    pub(crate) max_i: f32,
    pub(crate) max_err: f32,
    pub(crate) max_output: f32,
    pub(crate) ff_vel: f32,
    pub(crate) ff_accel: f32,
    /// Half width and gain of the dead band, if there is one.
    pub(crate) dead_band: Option<(f32, f32)>,
    pub(crate) filters: [Filter; 3],
}

/// The prepared settings of an axis. Of a disabled axis only the input counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AxisPlan {
    pub(crate) input: Input,
    pub(crate) mode: Option<OutputMode>,
    /// True if there is no compensation: steps and microsteps follow the command.
    pub(crate) is_open_loop: bool,
    pub(crate) is_slave: bool,
    /// True if a limit switch is watched.
    pub(crate) watches_switches: bool,
    pub(crate) has_backlash: bool,
    pub(crate) soft_limit_neg: f64,
    pub(crate) soft_limit_pos: f64,
    pub(crate) max_following_error: f64,
    /// The distance that an encoder that follows the command covers in a tick, in position units; 0 for no limit.
    pub(crate) reach: f64,
    pub(crate) gains: Gains,
}

impl AxisPlan {
    /// Returns whether this axis' tick depends on other axes: on their motion, their load, or a step generator that
    /// both name.
    pub(super) fn is_coupled(&self, axis: AxisId) -> bool {
        self.is_slave
            || matches!(self.input, Input::Encoder(encoder) if encoder.turned_by != Some(axis))
            || OutputMode::has_generator(self.mode)
    }

    /// Prepares the settings of an axis.
    pub(super) fn of(
        memory: &mut GuestMemory,
        wiring: &Wiring,
        axis: AxisId,
        derivative_method: Option<GuestAddr>,
    ) -> Self {
        let derives_error = derivative_method.is_some_and(|method| memory.peek::<i32>(method) != 0);
        let input = input(memory, wiring, axis);
        let chan = AxisView::of(memory, axis);
        if chan.get(Chan::ENABLE) == 0 {
            return Self { input, ..Self::default() };
        }
        let mode = OutputMode::new(chan.get(Chan::OUTPUT_MODE));
        Self {
            input,
            mode,
            is_open_loop: OutputMode::is_open_loop(mode),
            is_slave: chan.get(Chan::MASTER_AXIS) >= 0,
            watches_switches: watches_switches(&chan),
            has_backlash: chan.get(Chan::BACKLASH_MODE) != BacklashMode::Off.get(),
            soft_limit_neg: chan.get(Chan::SOFT_LIMIT_NEG).into(),
            soft_limit_pos: chan.get(Chan::SOFT_LIMIT_POS).into(),
            max_following_error: chan.get(Chan::MAX_FOLLOWING_ERROR),
            reach: COUNTS_PER_TICK * f64::from(chan.get(Chan::INPUT_GAIN0)).abs(),
            gains: Gains { derives_error, ..gains(&chan) },
        }
    }
}

/// Returns whether an axis watches a limit switch.
fn watches_switches(chan: &AxisView<'_>) -> bool {
    const WATCHED: i32 = 3;
    chan.get(Chan::LIMIT_SWITCH_OPTIONS) & WATCHED != 0
}

fn input(memory: &mut GuestMemory, wiring: &Wiring, axis: AxisId) -> Input {
    let chan = AxisView::of(memory, axis);
    match InputMode::new(chan.get(Chan::INPUT_MODE)) {
        Some(InputMode::Encoder) => encoder(memory, wiring, axis).map_or(Input::None, Input::Encoder),
        Some(InputMode::Adc) => Input::Adc,
        Some(InputMode::Resolver) => Input::Resolver,
        Some(InputMode::None | InputMode::User) | None => Input::None,
    }
}

/// The encoder read by an axis, if there is one at its input.
pub(crate) fn encoder(memory: &mut GuestMemory, wiring: &Wiring, axis: AxisId) -> Option<Encoder> {
    let turned_by = wiring.driving_axis(memory, axis);
    if turned_by.is_none() && !wiring.reads_hand(memory, axis) {
        return None;
    }
    let is_held = wiring.is_hand_alone(memory, axis);
    let chan = AxisView::of(memory, axis);
    let gain = f64::from(chan.get(Chan::INPUT_GAIN0));
    let channel = chan.get(Chan::INPUT_CHAN0);
    let turned_gain =
        turned_by.map_or(gain, |axis| f64::from(AxisView::of(memory, axis).get(Chan::INPUT_GAIN0)));
    Some(Encoder { gain, channel: u32::try_from(channel).ok(), turned_by, turned_gain, is_held })
}

#[inline(always)]
fn gains(chan: &AxisView<'_>) -> Gains {
    let gain = |field: Field<f32>| chan.get(field);
    // A negative or NaN limit lets nothing through.
    let limit = |field| gain(field).max(0.0);
    let (range, slope) = (gain(Chan::DEAD_BAND_RANGE), gain(Chan::DEAD_BAND_GAIN));
    Gains {
        p: gain(Chan::P),
        i: gain(Chan::I),
        d: gain(Chan::D),
        derives_error: false,
        max_i: limit(Chan::MAX_I),
        max_err: limit(Chan::MAX_ERR),
        max_output: limit(Chan::MAX_OUTPUT),
        ff_vel: gain(Chan::FF_VEL),
        ff_accel: gain(Chan::FF_ACCEL),
        dead_band: (range != 0.0 || slope != 1.0).then_some((range, slope)),
        filters: [
            filter(chan, Chan::IIR.element(0)),
            filter(chan, Chan::IIR.element(1)),
            filter(chan, Chan::IIR.element(2)),
        ],
    }
}

#[inline(always)]
fn filter(chan: &AxisView<'_>, iir: Field<Iir>) -> Filter {
    let get = |field: Field<f32>| chan.get(iir.field(field));
    let (a1, a2, b0, b1, b2) = (get(Iir::A1), get(Iir::A2), get(Iir::B0), get(Iir::B1), get(Iir::B2));
    let others = a1.to_bits() | a2.to_bits() | b1.to_bits() | b2.to_bits();
    let is_plain = others == 0 && b0.to_bits() == 1.0_f32.to_bits();
    Filter { is_plain, a1, a2, b0, b1, b2 }
}
