//! Headers of the C library.
//!
//! For the board only the vendor's header exists; but programs that were first tried on a PC include others. They
//! declare the functions of the firmware, and those added by our own C library (`driver/library`). All can be combined
//! with the vendor's header. Other headers are treated as empty, because the compiler knows the board's functions.

macro_rules! headers {
    ($($name:literal)*) => {
        const HEADERS: &[(&str, &str)] = &[$(($name, include_str!(concat!("standard/", $name)))),*];
    };
}

headers! {
    "assert.h" "ctype.h" "errno.h" "float.h" "inttypes.h" "iso646.h" "limits.h" "math.h" "setjmp.h" "stdalign.h"
    "stdarg.h" "stdbool.h" "stddef.h" "stdint.h" "stdio.h" "stdlib.h" "stdnoreturn.h" "string.h" "wchar.h"
}

/// Headers of other systems that are not needed here.
const EMPTY: &[&str] = &["locale.h", "memory.h", "signal.h", "strings.h", "tgmath.h", "time.h"];

/// The text of a standard header, if `name` is one.
pub(super) fn header(name: &str) -> Option<&'static str> {
    let known = HEADERS.iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
    let empty = || EMPTY.iter().any(|known| known.eq_ignore_ascii_case(name)).then_some("");
    known.map(|(_, text)| *text).or_else(empty)
}
