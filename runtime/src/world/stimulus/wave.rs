//! The course of an analog input over time.

use kmotiondef::{AxisId, Cycles};

/// A course, in counts of −2048 to 2047.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wave {
    /// One value.
    Constant(f64),
    /// A sine.
    Sine {
        /// Its middle.
        mean: f64,
        /// From the middle to the top.
        amplitude: f64,
        /// Periods in a second.
        hz: f64,
    },
    /// High for the first half of each period, low for the second.
    Square {
        /// The lower value.
        low: f64,
        /// The upper value.
        high: f64,
        /// Periods in a second.
        hz: f64,
    },
    /// From one value to another, where it stays.
    Ramp {
        /// The first value.
        from: f64,
        /// The last value.
        to: f64,
        /// The duration.
        over: Cycles,
    },
    /// The load of an axis.
    Follows {
        /// The axis.
        axis: AxisId,
        /// Counts for each unit.
        gain: f64,
        /// Counts where the load is 0.
        offset: f64,
    },
}

impl Wave {
    /// The value at a time after its beginning; `load` yields the position of an axis.
    pub(crate) fn value(&self, elapsed: Cycles, load: impl Fn(AxisId) -> f64) -> f64 {
        let seconds = elapsed.get() as f64 / Cycles::PER_SECOND.get() as f64;
        match *self {
            Self::Constant(value) => value,
            Self::Sine { mean, amplitude, hz } => {
                mean + amplitude * libm::sin(seconds * hz * std::f64::consts::TAU)
            }
            Self::Square { low, high, hz } => {
                let phase = seconds * hz;
                if phase - libm::floor(phase) < 0.5 { high } else { low }
            }
            Self::Ramp { from, to, over } if elapsed < over => {
                from + (to - from) * (elapsed.get() as f64 / over.get() as f64)
            }
            Self::Ramp { to, .. } => to,
            Self::Follows { axis, gain, offset } => gain * load(axis) + offset,
        }
    }

    /// Returns whether the wave is constant from `elapsed` on.
    pub(crate) fn is_over(&self, elapsed: Cycles) -> bool {
        match self {
            Self::Constant(_) => true,
            Self::Ramp { over, .. } => elapsed >= *over,
            Self::Sine { .. } | Self::Square { .. } | Self::Follows { .. } => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waveforms_have_the_expected_values() {
        let ms = |ms: i64| Cycles::new(ms * Cycles::PER_SECOND.get() / 1000);
        let ramp = Wave::Ramp { from: 0.0, to: 100.0, over: ms(10) };
        let square = Wave::Square { low: -5.0, high: 5.0, hz: 100.0 };
        let sine = Wave::Sine { mean: 10.0, amplitude: 100.0, hz: 25.0 };
        for (wave, at, expect) in [
            (ramp, 5, 50.0),
            (ramp, 20, 100.0),
            (square, 4, 5.0),
            (square, 6, -5.0),
            (square, 11, 5.0),
            (sine, 10, 110.0),
        ] {
            assert_eq!(wave.value(ms(at), |_| 0.0), expect, "{wave:?} {at}");
        }
    }
}
