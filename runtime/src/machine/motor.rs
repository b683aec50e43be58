//! A motor with its load: the speed that results from an amplifier's output. Source: plant.md sections 3 and 4.

use std::f64::consts::TAU;

use kmotiondef::limits::TIMEBASE;

use super::description::{self, Axis};

/// Units a second for a count of PWM, and for a count of an analog output.
const PWM_KU: f64 = 435.0;
const DAC_KU: f64 = 50.0;

/// The signal that an amplifier receives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum AmplifierSignal {
    /// PWM counts.
    Pwm(f64),
    /// Counts of an analog output.
    Dac(f64),
    /// Counts of a current.
    Current(f64),
    /// A vector on the phases: magnitude in PWM counts, angle in cycles.
    Vector(f64, f64),
}

/// A motor with its load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motor {
    ku: Option<f64>,
    /// The fraction of a difference of speeds that remains after a tick.
    decay: f64,
    friction: f64,
    /// The speed that a constant load adds.
    pull: f64,
    ka: f64,
    /// The fraction of the speed that remains after a tick with viscous friction only.
    viscous: f64,
    cycles_per_unit: Option<f64>,
    rotor_phase: f64,
}

impl Motor {
    /// The motor of an axis.
    pub(crate) fn new(axis: &Axis) -> Self {
        let description::Motor { ku, tau_s, friction, ka, tau_v_s, inertia, pull } = axis.motor;
        Self {
            ku,
            decay: libm::exp(-TIMEBASE / (tau_s * inertia)),
            friction,
            pull,
            ka: ka / inertia,
            viscous: 1.0 - TIMEBASE / (tau_v_s * inertia),
            cycles_per_unit: axis.rotor.cycles_per_unit,
            rotor_phase: axis.rotor.phase,
        }
    }

    /// Returns whether a constant load moves it while it is not driven.
    #[inline(always)]
    pub(crate) fn is_pulled(&self) -> bool {
        self.pull != 0.0
    }

    /// Another constant load, in units per second.
    pub(crate) fn load_with(&mut self, pull: f64) {
        self.pull = pull;
    }

    /// Electrical cycles of a unit, the axis' own if the machine file gives none.
    pub(crate) fn cycles(&self, own: f64) -> f64 {
        self.cycles_per_unit.unwrap_or(own.abs())
    }

    /// Electrical angle of the rotor in cycles.
    pub(crate) fn angle(&self, load: f64, cycles: f64) -> f64 {
        load * cycles + self.rotor_phase
    }

    /// The velocity a tick later; `own_cycles` is the axis' own value of its cycles.
    pub(crate) fn advance(&self, velocity: f64, applied: AmplifierSignal, load: f64, own_cycles: f64) -> f64 {
        match applied {
            AmplifierSignal::Pwm(counts) => self.accelerate(velocity, self.ku.unwrap_or(PWM_KU) * counts),
            AmplifierSignal::Dac(counts) => self.accelerate(velocity, self.ku.unwrap_or(DAC_KU) * counts),
            AmplifierSignal::Vector(magnitude, angle) => {
                let lead = angle - self.angle(load, self.cycles(own_cycles));
                let torque = magnitude * libm::sin(TAU * (lead - libm::floor(lead)));
                self.accelerate(velocity, self.ku.unwrap_or(PWM_KU) * torque)
            }
            AmplifierSignal::Current(counts) => {
                let pushed = velocity * self.viscous + self.ka * counts * TIMEBASE;
                self.apply_friction(velocity, pushed, self.ka * counts == 0.0)
            }
        }
    }

    /// Speeds up towards `target`, of which friction takes its part.
    fn accelerate(&self, velocity: f64, target: f64) -> f64 {
        let target = target + self.pull;
        if velocity == 0.0 && target.abs() <= self.friction {
            return 0.0;
        }
        let direction = if velocity == 0.0 { target } else { velocity };
        let aim = target - libm::copysign(self.friction, direction);
        self.apply_friction(velocity, aim + (velocity - aim) * self.decay, target.abs() <= self.friction)
    }

    /// Applies friction, which stops but does not reverse the motion; crawling counts as standing once the motor is not
    /// driven.
    fn apply_friction(&self, before: f64, after: f64, is_undriven: bool) -> f64 {
        const CRAWL: f64 = 1e-6;
        let reverses = before * after < 0.0;
        if is_undriven && (reverses && self.friction > 0.0 || after.abs() < CRAWL) { 0.0 } else { after }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motor(friction: f64, inertia: f64) -> Motor {
        let mut axis = Axis::default();
        axis.motor.friction = friction;
        axis.motor.inertia = inertia;
        Motor::new(&axis)
    }

    /// The velocity after some seconds of a constant drive, from rest.
    fn after(motor: &Motor, applied: AmplifierSignal, seconds: f64) -> f64 {
        let ticks = (seconds / TIMEBASE) as usize;
        (0..ticks).fold(0.0, |velocity, _| motor.advance(velocity, applied, 0.0, 0.0))
    }

    #[test]
    fn a_voltage_approaches_its_speed_with_the_time_constant() {
        let end = 435.0 * 100.0;
        let speed = after(&motor(0.0, 1.0), AmplifierSignal::Pwm(100.0), 0.02);
        assert!((speed / end - 0.632).abs() < 0.003, "{speed}");
        let heavy = after(&motor(0.0, 3.0), AmplifierSignal::Pwm(100.0), 0.06);
        assert!((heavy / end - 0.632).abs() < 0.003, "{heavy}");
    }

    #[test]
    fn friction_holds_slows_and_stops() {
        let motor = motor(435.0 * 10.0, 1.0);
        assert_eq!(after(&motor, AmplifierSignal::Pwm(10.0), 1.0), 0.0);
        let speed = after(&motor, AmplifierSignal::Pwm(30.0), 1.0);
        assert!((speed - 435.0 * 20.0).abs() < 1e-6, "{speed}");
        let mut velocity = speed;
        let ticks = (0..10_000).find(|_| {
            velocity = motor.advance(velocity, AmplifierSignal::Pwm(0.0), 0.0, 0.0);
            velocity == 0.0
        });
        assert!(ticks.is_some_and(|ticks| ticks < 1000), "{ticks:?}");
    }

    #[test]
    fn a_constant_load_pulls_unless_friction_holds_it() {
        let pulled = |friction| {
            let mut axis = Axis::default();
            (axis.motor.pull, axis.motor.friction) = (-100.0, friction);
            after(&Motor::new(&axis), AmplifierSignal::Pwm(0.0), 1.0)
        };
        assert!((pulled(0.0) + 100.0).abs() < 1e-6, "{}", pulled(0.0));
        assert_eq!(pulled(150.0), 0.0);
    }

    #[test]
    fn a_current_acts_as_a_torque() {
        let speed = after(&motor(0.0, 1.0), AmplifierSignal::Current(100.0), 0.01);
        assert!((speed - 2000.0).abs() < 40.0, "{speed}");
        let heavy = after(&motor(0.0, 2.0), AmplifierSignal::Current(100.0), 0.01);
        assert!((heavy - 1000.0).abs() < 20.0, "{heavy}");
    }
}
