//! The C headers that user programs include, as part of the compiler.

/// Every header: the name that `#include` uses, and its text.
pub const EMBEDDED: &[(&str, &[u8])] = &[
    ("KMotionDef.h", include_bytes!("../include/KMotionDef.h")),
    ("PC-DSP.h", include_bytes!("../include/PC-DSP.h")),
];
