//! Low-pass smoothing of a path, and the spline that ends a smoothed path.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::Chan;
use kmotiondef::variables::{KLP, SPLINE_TAU_FACTOR, TAU_KLP};
use kmotiondef::{AxisId, GuestAddr};
use vm::memory::GuestMemory;

use super::system::{self, LETTERS};
use crate::views::Typed;

/// Stores where the path puts an axis, and its destination after the filter.
pub(crate) fn move_to(memory: &mut GuestMemory, axis: AxisId, position: f64) {
    let klp = memory.get(KLP);
    memory.set_axis(axis, Chan::UNFILTERED_DEST, position);
    let dest =
        if klp == 0.0 { position } else { klp * memory.axis(axis, Chan::DEST) + (1.0 - klp) * position };
    memory.set_axis(axis, Chan::DEST, dest);
}

/// The way from where the filter has left the axes to the end of the path.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spline {
    /// The entry that ended the path; a program that starts another path moves away from it.
    end: GuestAddr,
    /// Seconds done.
    t: f64,
    duration: f64,
    cubics: [Option<Cubic>; LETTERS],
}

/// The motion of one axis: x0 + v0·t + b·t² + a·t³.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cubic {
    axis: AxisId,
    a: f64,
    b: f64,
    v0: f64,
    x0: f64,
}

impl Spline {
    /// The spline from the axes' destinations and velocities to rest at the end of the path; `None` if the path is
    /// not smoothed. One that is smoothed by a `KLP` without its `TauKLP` divides by a duration of 0: the destinations
    /// are not numbers then (coordinated-motion.md section 6).
    pub(crate) fn plan(memory: &GuestMemory, end: GuestAddr) -> Option<Self> {
        let exact = f64::from(memory.get(SPLINE_TAU_FACTOR)) * f64::from(memory.get(TAU_KLP));
        let duration = f64::from(exact as f32);
        let is_undefined = memory.get(KLP) != 0.0 && duration == 0.0;
        if duration < TIMEBASE && !is_undefined {
            return None;
        }
        let cubics = system::letters(memory).map(|axis| Some(Cubic::plan(memory, axis?, exact, duration)));
        Some(Self { end, t: 0.0, duration, cubics })
    }

    /// Returns whether it belongs to the path that ended at an entry.
    pub(crate) fn ends_at(&self, end: GuestAddr) -> bool {
        self.end == end
    }

    /// One tick. Says whether another one follows: the last is the one before the duration has passed.
    pub(crate) fn step(&mut self, memory: &mut GuestMemory) -> bool {
        self.t += TIMEBASE;
        for cubic in self.cubics.iter().flatten() {
            memory.set_axis(cubic.axis, Chan::DEST, cubic.at(self.t));
        }
        self.t + TIMEBASE <= self.duration
    }
}

impl Cubic {
    /// The board divides by the duration as a single, and multiplies with the exact one.
    fn plan(memory: &GuestMemory, axis: AxisId, exact: f64, duration: f64) -> Self {
        let x0 = memory.axis(axis, Chan::DEST);
        let v0 = f64::from(memory.axis(axis, Chan::LAST_VEL));
        let way = memory.axis(axis, Chan::UNFILTERED_DEST) - x0;
        let b = (3.0 * way - 2.0 * v0 * exact) / (duration * duration);
        let a = (v0 * exact - 2.0 * way) / (duration * duration * duration);
        Self { axis, a, b, v0, x0 }
    }

    fn at(&self, t: f64) -> f64 {
        ((self.a * t + self.b) * t + self.v0) * t + self.x0
    }
}
