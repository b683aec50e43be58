//! The record of a run that `cc67 compare --random` and the recorded vectors share: a program leaves it in the gather
//! buffer, and the scenario's own text writes it there.

/// The first word of the variables of the path, a double each.
pub const PATH: u32 = 2784;

/// The variables of the path in their order.
pub const PATH_VARIABLES: [&str; 32] = [
    "CS0_t",
    "TimeExecuted",
    "TimeBase",
    "TimeBaseDesired",
    "TimeBaseDelta",
    "TimeDownloaded",
    "TimeLost",
    "LastFRO",
    "LastRapidFRO",
    "DecelTime",
    "NomDecel2TB2",
    "StoppingState",
    "Flushed",
    "DoingRapid",
    "CoordSystem0",
    "LastCoordSystem0",
    "ParametricIndex",
    "ParametricIndexWrapped",
    "KLP",
    "TauKLP",
    "VirtualBits",
    "CheckDoneBuf",
    "CheckDoneXYZABC",
    "CheckDone0",
    "CheckDone1",
    "CheckDone2",
    "CheckDone3",
    "CheckDone4",
    "CheckDone5",
    "CheckDone6",
    "CheckDone7",
    "VirtualBitsEx",
];

/// The first word of the states of the axes: the index of the present coefficients and 1, or 0.
pub const STATES: u32 = 2900;

/// The first word of the samples, a double for each column.
pub const SAMPLES: u32 = 2944;

/// The tolerance of a double, relative to the larger of it and 1: quotients differ in the last bit.
pub const PRECISION: f64 = 1e-9;
