//! The registers of the real processor that firmware functions change.
//!
//! A compiler that keeps values in registers across the call of a helper relies on these lists.
//! Source: `c67-subset.md` section 7 and `c67x.md` section 5.2 of the specification, measured.

use std::sync::LazyLock;

use kmotiondef::firmware::FIRMWARE_FUNCTIONS;

/// A0 to A9.
const ALL_A: &[u8] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9];
/// B0 to B9.
const ALL_B: &[u8] = ALL_A;
/// B0 to B2 and B4 to B9: all but the return address.
const NOT_B3: &[u8] = &[0, 1, 2, 4, 5, 6, 7, 8, 9];

/// Names of functions, and the registers of files A and B that they change.
type HelperRegisters = (&'static [&'static str], &'static [u8], &'static [u8]);

const ROWS: &[HelperRegisters] = &[
    (&["_divi"], &[0, 1, 2, 4, 6], &[0, 1, 2, 4, 5]),
    (&["_remi"], &[1, 2, 4, 5, 6], &[0, 1, 2, 4]),
    (&["_divu"], &[0, 1, 2, 4, 6], &[0, 1, 2, 4]),
    (&["_remu"], &[1, 4, 5, 7], &[0, 1, 2, 4]),
    (&["_divf"], &[3, 4], &[0, 5, 6]),
    (&["_divd"], &[4, 5, 6, 7], &[2, 6, 7, 8, 9]),
    (&["sqrt"], ALL_A, &[0, 4, 5, 6, 7]),
    (&["sqrtf"], &[0, 1, 2, 3, 4, 5], &[4, 5, 6]),
    (&["sin", "cos", "tan", "sinf", "cosf", "tanf"], ALL_A, NOT_B3),
    (&["asin", "acos", "atan", "atan2"], ALL_A, &[0, 2, 4, 5, 6, 7, 8, 9]),
    (&["asinf", "acosf", "atanf", "atan2f"], ALL_A, NOT_B3),
    (&["memcpy"], ALL_A, &[0, 1, 2, 4, 5]),
    (&["memset"], &[0, 1, 2, 3, 4, 5, 6, 7], &[0, 1, 2, 4]),
];

/// What each firmware function changes, by its number: every call of a program asks.
static CHANGED: LazyLock<Vec<u64>> =
    LazyLock::new(|| FIRMWARE_FUNCTIONS.iter().map(|row| of_name(row.name)).collect());

/// The registers that a call of the firmware function `number` may change, A0 in bit 0, B0 in bit 32.
pub(crate) fn registers(number: usize) -> u64 {
    CHANGED[number]
}

fn of_name(name: &str) -> u64 {
    let row = ROWS.iter().find(|(names, ..)| names.contains(&name));
    let (a, b) = row.map_or((ALL_A, ALL_B), |(_, a, b)| (*a, *b));
    bits(a) | bits(b) << 32
}

fn bits(numbers: &[u8]) -> u64 {
    numbers.iter().fold(0, |bits, number| bits | 1 << number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_named_function_exists() {
        for name in ROWS.iter().flat_map(|(names, ..)| *names) {
            assert!(FIRMWARE_FUNCTIONS.iter().any(|row| row.name == *name), "{name}");
        }
    }

    #[test]
    fn unlisted_functions_follow_the_calling_convention() {
        assert_eq!(of_name("printf"), 0x0000_03FF_0000_03FF);
        assert_eq!(of_name("_divf"), 0x0000_0061_0000_0018);
    }
}
