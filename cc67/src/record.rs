//! The record of a run, shared by `cc67 compare --random` and the recorded vectors: a program leaves it in the gather
//! buffer, where the text of the scenario writes it.

/// The first word of the path variables, one double each.
pub const PATH: u32 = 2784;

/// The path variables in their order.
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

/// The first word of the states of the axes: for each, 1 plus the index of its present coefficients, or 0 for none.
pub const STATES: u32 = 2900;

/// The first word of the samples, one double for each column.
pub const SAMPLES: u32 = 2944;

/// The tolerance of a double, relative to its size but at least absolute: quotients differ in the last bit.
pub const PRECISION: f64 = 1e-9;
