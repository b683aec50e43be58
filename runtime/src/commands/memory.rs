//! State that script commands keep between commands.

use kmotiondef::AxisId;

use crate::servo::coordinated::download::Point;

/// The latest line that was sent in hexadecimal; at power-up one from 0 to 0.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Geometry {
    pub(super) begin: Point,
    pub(super) end: Point,
}

/// A recorded motion in progress.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Experiment {
    pub(super) axis: AxisId,
    pub(super) amount: f64,
    pub(super) jumps: bool,
    /// Ticks at which the axis leaves and returns.
    pub(super) legs: [u64; 2],
    pub(super) done: usize,
}
