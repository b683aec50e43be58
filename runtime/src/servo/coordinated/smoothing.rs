//! Low-pass smoothing of a path, and the spline that ends a smoothed path.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::Chan;
use kmotiondef::variables::{CS0_TIME_BASE, KLP, LAST_VALID_TRAJ_SEGMENT, SPLINE_TAU_FACTOR, TAU_KLP};
use kmotiondef::{AxisId, GuestAddr};
use vm::memory::GuestMemory;

use super::segment::Entry;
use super::system::LETTERS;
use crate::arithmetic::division::divide;
use crate::views::TypedAccess;

/// Stores where the path puts an axis, and its destination after the filter.
pub(crate) fn move_to(memory: &mut GuestMemory, axis: AxisId, position: f64) {
    let klp = memory.get(KLP);
    memory.set_axis(axis, Chan::UNFILTERED_DEST, position);
    let dest =
        if klp == 0.0 { position } else { klp * memory.axis(axis, Chan::DEST) + (1.0 - klp) * position };
    memory.set_axis(axis, Chan::DEST, dest);
}

/// The path from the axes' positions after the filter to the end of the path.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spline {
    /// The entry that ended the path; a program that starts another path moves away from it.
    end: GuestAddr,
    /// The time of the next tick. That of the first is the time base of the path.
    t: f64,
    duration: f64,
    cubics: [Option<Cubic>; LETTERS],
}

/// The factors of a duration T, with which the cubics of all axes are computed. The board rounds 1/T and its square to
/// singles.
struct Factors {
    /// 2/T³.
    cubic_of_way: f64,
    /// 1/T².
    cubic_of_speed: f64,
    /// −3T/2.
    square_of_cubic: f64,
    /// 1/2T.
    square_of_speed: f64,
}

impl Factors {
    fn new(duration: f64) -> Self {
        let rate = divide(1.0, duration) as f32;
        let square = f64::from(rate * rate);
        let rate = f64::from(rate);
        Self {
            cubic_of_way: (rate + rate) * square,
            cubic_of_speed: square,
            square_of_cubic: duration * -1.5,
            square_of_speed: rate * 0.5,
        }
    }
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
    /// The spline from the axes' destinations and velocities to rest at the end of the path; `None` if the path is not
    /// smoothed or has not moved. If it is smoothed by a `KLP` without `TauKLP`, it divides by a duration of 0, and the
    /// destinations become NaN (coordinated-motion.md section 6).
    ///
    /// It moves the axes of the last segment, which may no longer be those of the coordinate system.
    pub(crate) fn plan(memory: &GuestMemory, end: GuestAddr) -> Option<Self> {
        let last = memory.get(LAST_VALID_TRAJ_SEGMENT);
        if memory.get(KLP) == 0.0 || last.is_null() {
            return None;
        }
        let duration = f64::from(memory.get(SPLINE_TAU_FACTOR) * memory.get(TAU_KLP));
        let factors = Factors::new(duration);
        let cubics = Entry::at(last).axes(memory).map(|axis| Some(Cubic::plan(memory, axis?, &factors)));
        Some(Self { end, t: memory.get(CS0_TIME_BASE), duration, cubics })
    }

    /// Returns whether it belongs to the path that ended at an entry.
    pub(crate) fn ends_at(&self, end: GuestAddr) -> bool {
        self.end == end
    }

    /// Executes one tick. Returns whether another one follows; there is always at least one.
    pub(crate) fn step(&mut self, memory: &mut GuestMemory) -> bool {
        for cubic in self.cubics.iter().flatten() {
            memory.set_axis(cubic.axis, Chan::DEST, cubic.at(self.t));
        }
        self.t += TIMEBASE;
        self.t <= self.duration
    }
}

impl Cubic {
    fn plan(memory: &GuestMemory, axis: AxisId, factors: &Factors) -> Self {
        let x0 = memory.axis(axis, Chan::DEST);
        let v0 = f64::from(memory.axis(axis, Chan::LAST_VEL));
        let back = x0 - memory.axis(axis, Chan::UNFILTERED_DEST);
        let a = factors.cubic_of_way * back + factors.cubic_of_speed * v0;
        let b = factors.square_of_cubic * a - factors.square_of_speed * v0;
        Self { axis, a, b, v0, x0 }
    }

    fn at(&self, t: f64) -> f64 {
        ((self.a * t + self.b) * t + self.v0) * t + self.x0
    }
}
