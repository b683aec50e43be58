//! Costs of the board's formatter and converter, in cycles (costs.md section 4).
//!
//! Fitted there to recorded calls. Those of floating numbers count the steps that find the digits, fitted to 1,250 calls of
//! random values and precisions on a booted firmware: half of them within 1 %, the worst within 6 %.

use super::decimal::{Digits, Steps};

/// The cost of a formatter call in addition to its plain characters and conversions, if it has plain characters.
pub(super) const PLAIN_TEXT: u32 = 32;

/// A plain character of a format.
pub(super) const PLAIN_CHARACTER: u32 = 53;

/// `%%`
pub(super) const PERCENT: u32 = 1190;

/// A flag of a conversion.
pub(super) const FLAG: u32 = 60;

/// A width, and each character that fills it.
pub(super) const fn width(fill: u32) -> u32 {
    90 + 35 * fill
}

/// `%d` and `%u` of this many digits.
pub(super) const fn decimal(digits: u32, is_negative: bool) -> u32 {
    1600 + 146 * digits + if is_negative { 27 } else { 0 }
}

/// `%x` and `%o` of this many digits.
pub(super) const fn hexadecimal(digits: u32) -> u32 {
    1615 + 112 * digits
}

/// `%c`
pub(super) const CHARACTER: u32 = 1364;

/// `%s` of this many characters.
pub(super) const fn text(characters: u32) -> u32 {
    1256 + 35 * characters
}

/// The sign of a floating-point conversion.
pub(super) const MINUS: u32 = 27;

/// `%f`
pub(super) fn fixed(precision: Option<usize>, found: &Digits) -> u32 {
    let (steps, decimals) = (&found.steps, precision.unwrap_or(6) as u32);
    let (is_zero, is_below) = match (found.digits.is_empty(), *steps == Steps::default()) {
        (true, is_zero) => (is_zero, !is_zero),
        (false, _) => (false, false),
    };
    let behind = if is_zero { decimals + 1 } else { (found.digits.len() as u32).saturating_sub(steps.whole) };
    1845 + precision_cost(precision, [198, 33])
        + integer_part(steps, [336, 39, 391, 30])
        + 21 * steps.zeros
        + rounding(steps, [18, 8])
        + 141 * steps.scaled
        + 39 * decimals
        + 121 * behind
        + if_so(is_zero, 20)
        + if_so(is_below, 101)
        - if_so(decimals == 0, 92)
}

/// `%e`
pub(super) fn scientific(precision: Option<usize>, found: &Digits) -> u32 {
    let (steps, decimals) = (&found.steps, precision.unwrap_or(6) as u32);
    2700 + precision_cost(precision, [259, 75])
        + 30 * steps.zeros
        + rounding(steps, [36, 6])
        + 105 * steps.scaled
        + 157 * decimals
        - if_so(decimals == 0, 137)
        - if_so(found.digits.is_empty(), 108)
}

/// `%g`
pub(super) fn general(precision: Option<usize>, found: &Digits) -> u32 {
    let (steps, count) = (&found.steps, precision.unwrap_or(6).max(1));
    let is_zero = found.digits.is_empty();
    let stripped = if is_zero { count - 1 } else { found.zeros_at_end() };
    let [zero, exponent] = if found.is_scientific(count) { [32, 360] } else { [72, 0] };
    1825 + precision_cost(precision, [235, 62])
        + integer_part(steps, [351, 43, 227, 32])
        + zero * steps.zeros
        + rounding(steps, [26, 9])
        + 109 * steps.scaled
        + 143 * count as u32
        + exponent
        - 24 * stripped as u32
        - if_so(count == 1, 42)
        - if_so(is_zero, 35)
}

/// `cost` if `reason` holds, otherwise 0.
const fn if_so(reason: bool, cost: u32) -> u32 {
    if reason { cost } else { 0 }
}

/// A precision that the format gives, and more if it has two digits.
fn precision_cost(precision: Option<usize>, [cost, more]: [u32; 2]) -> u32 {
    if_so(precision.is_some(), cost) + if_so(precision.is_some_and(|precision| precision >= 10), more)
}

/// The cost of the digits before the point: for none, for a single one, for each digit, and for each bit of the
/// divisions.
const fn integer_part(steps: &Steps, [none, single, each, divided]: [u32; 4]) -> u32 {
    match steps.whole {
        0 => none,
        whole => if_so(whole == 1, single) + each * whole + divided * steps.divided,
    }
}

/// A last digit that is rounded up, and the nines that it changes.
const fn rounding(steps: &Steps, [raised, carried]: [u32; 2]) -> u32 {
    if_so(steps.is_raised, raised) + carried * steps.carried
}

/// Returns the cost of a conversion of `sscanf` that used this many characters.
pub(super) const fn scanned(letter: u8, characters: u32) -> u32 {
    match letter {
        b'x' | b'X' | b'p' | b'i' => 520 + 400 * characters,
        b'd' | b'u' | b'o' => 590 + 377 * characters,
        b'f' | b'e' | b'E' | b'g' | b'G' => 830 + 135 * characters,
        _ => 480 + 64 * characters,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value as Json;

    use crate::text::format::tests::counted;
    use crate::text::vectors::{call, rows};

    /// The cases of a function: format, arguments, cycles without wait states.
    fn cases(name: &str) -> Vec<(String, f64)> {
        let rows = rows("costs.jsonl");
        let row = rows.iter().find(|row| row["kind"] == "function" && row["name"] == name);
        let cases = row.and_then(|row| row["cases"].as_array()).expect("it was measured");
        let case = |case: &Json| {
            let arguments = case["args"].as_str()?.to_owned();
            Some((arguments, case["cycles"][0].as_f64()?))
        };
        cases.iter().filter_map(case).collect()
    }

    /// Returns the relative errors of the counted cycles, sorted, the worst last; with the cases.
    fn errors(name: &str, fixed: impl Fn(&[u8]) -> u32) -> Vec<(f64, String)> {
        let mut errors = Vec::new();
        for (arguments, recorded) in cases(name) {
            let (format, values) = arguments.split_once('|').unwrap_or((&arguments, ""));
            // `alternatives | of one cost` and remarks are no arguments.
            if values.contains(['|', '(']) || format.contains('(') || format.contains("chars") {
                continue;
            }
            let format = format.replace('\n', "\\n");
            let separator = if values.is_empty() { "" } else { "," };
            let (format, values) = call(&format!("\"{format}\"{separator}{values}"));
            let found = counted(&format, values);
            let cycles = f64::from(found.cycles + fixed(&found.text));
            errors.push(((cycles - recorded).abs() / recorded, arguments));
        }
        errors.sort_by(|a, b| a.0.total_cmp(&b.0));
        errors
    }

    #[test]
    fn formatting_costs_about_what_the_board_spends() {
        let errors = errors("sprintf", |_| 83);
        assert!(errors.len() > 100, "{}", errors.len());
        let (median, case) = &errors[errors.len() / 2];
        assert!(*median < 0.02, "{median} {case}");
        let (most, case) = &errors[errors.len() * 95 / 100];
        assert!(*most < 0.05, "{most} {case}");
    }

    #[test]
    fn printing_costs_about_what_the_board_spends() {
        let errors = errors("printf", |text| 367 + 133 * text.len() as u32);
        assert!(errors.len() > 10, "{}", errors.len());
        let (median, case) = &errors[errors.len() / 2];
        assert!(*median < 0.02, "{median} {case}");
    }
}
