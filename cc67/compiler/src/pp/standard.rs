//! Headers of the C library.
//!
//! The vendor's header declares what the board offers, and no others exist for it; yet
//! programs that were tried on a PC first include them. They are taken as if empty, because
//! the compiler knows the board's functions, except for those that consist of macros and types.

/// The text of a standard header, if `name` is one.
pub(super) fn header(name: &str) -> Option<&'static str> {
    let empty = [
        "assert.h",
        "ctype.h",
        "errno.h",
        "inttypes.h",
        "locale.h",
        "math.h",
        "memory.h",
        "setjmp.h",
        "signal.h",
        "stdalign.h",
        "stdarg.h",
        "stddef.h",
        "stdio.h",
        "stdlib.h",
        "stdnoreturn.h",
        "string.h",
        "strings.h",
        "tgmath.h",
        "time.h",
    ];
    let lower = name.to_ascii_lowercase();
    match lower.as_str() {
        "stdbool.h" => Some(STDBOOL),
        "stdint.h" => Some(STDINT),
        "limits.h" => Some(LIMITS),
        "float.h" => Some(FLOAT),
        _ => empty.contains(&lower.as_str()).then_some(""),
    }
}

const STDBOOL: &str = "\
#ifndef __bool_true_false_are_defined
#define __bool_true_false_are_defined 1
#define bool _Bool
#define true 1
#define false 0
#endif
";

const STDINT: &str = "\
#ifndef INT32_MAX
typedef signed char int8_t;
typedef unsigned char uint8_t;
typedef short int16_t;
typedef unsigned short uint16_t;
typedef int int32_t;
typedef unsigned int uint32_t;
typedef long long int64_t;
typedef unsigned long long uint64_t;
typedef int intptr_t;
typedef unsigned int uintptr_t;
typedef long long intmax_t;
typedef unsigned long long uintmax_t;
#define INT8_MIN (-128)
#define INT8_MAX 127
#define UINT8_MAX 255
#define INT16_MIN (-32768)
#define INT16_MAX 32767
#define UINT16_MAX 65535
#define INT32_MIN (-2147483647 - 1)
#define INT32_MAX 2147483647
#define UINT32_MAX 4294967295u
#endif
";

const LIMITS: &str = "\
#ifndef CHAR_BIT
#define CHAR_BIT 8
#define SCHAR_MIN (-128)
#define SCHAR_MAX 127
#define UCHAR_MAX 255
#define CHAR_MIN (-128)
#define CHAR_MAX 127
#define SHRT_MIN (-32768)
#define SHRT_MAX 32767
#define USHRT_MAX 65535
#define INT_MIN (-2147483647 - 1)
#define INT_MAX 2147483647
#define UINT_MAX 4294967295u
#define LONG_MIN (-2147483647L - 1)
#define LONG_MAX 2147483647L
#define ULONG_MAX 4294967295uL
#endif
";

const FLOAT: &str = "\
#ifndef FLT_MAX
#define FLT_DIG 6
#define FLT_EPSILON 1.19209290e-7F
#define FLT_MIN 1.17549435e-38F
#define FLT_MAX 3.40282347e+38F
#define DBL_DIG 15
#define DBL_EPSILON 2.2204460492503131e-16
#define DBL_MIN 2.2250738585072014e-308
#define DBL_MAX 1.7976931348623157e+308
#endif
";
