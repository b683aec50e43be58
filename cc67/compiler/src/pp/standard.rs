//! Headers of the C library.
//!
//! No header but the vendor's exists for the board; yet programs that were tried on a PC first include them. They say
//! what the firmware offers, and what our own C library adds (`driver/library`). All may be beside the vendor's
//! header. The others are taken as if empty, because the compiler knows the board's functions.

macro_rules! headers {
    ($($name:literal)*) => {
        const HEADERS: &[(&str, &str)] = &[$(($name, include_str!(concat!("standard/", $name)))),*];
    };
}

headers! {
    "assert.h" "ctype.h" "errno.h" "float.h" "inttypes.h" "iso646.h" "limits.h" "math.h" "setjmp.h" "stdalign.h"
    "stdarg.h" "stdbool.h" "stddef.h" "stdint.h" "stdio.h" "stdlib.h" "stdnoreturn.h" "string.h" "wchar.h"
}

/// Headers of other systems without a use here.
const EMPTY: &[&str] = &["locale.h", "memory.h", "signal.h", "strings.h", "tgmath.h", "time.h"];

/// The text of a standard header, if `name` is one.
pub(super) fn header(name: &str) -> Option<&'static str> {
    let known = HEADERS.iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
    let empty = || EMPTY.iter().any(|known| known.eq_ignore_ascii_case(name)).then_some("");
    known.map(|(_, text)| *text).or_else(empty)
}
