//! Costs of the board's formatter and converter, in cycles (costs.md section 4).
//!
//! Fitted there to recorded calls: most are within 2 % of the board, the worst within 17 %.

/// The cost of a call of the formatter beyond its plain characters and conversions, if it has plain characters.
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

/// `%f`, by its precision and the decimal exponent of the value.
pub(super) fn fixed(precision: Option<u32>, exponent: i32) -> u32 {
    let base = match precision {
        None => 3272,
        Some(0) => 2450,
        Some(precision) => 2537 + 164 * precision,
    };
    let Ok(exponent) = u32::try_from(exponent) else { return base - 190 };
    let steps = exponent.min(9);
    base + 390 * steps + 58 * steps * steps + 255 * (exponent - steps)
}

/// `%e`, by its precision and the decimal exponent of the value.
pub(super) fn scientific(precision: Option<u32>, exponent: i32) -> u32 {
    let base = precision.map_or(3590, |precision| 2880 + 168 * precision);
    base + exponent.unsigned_abs() * if exponent < 0 { 45 } else { 100 }
}

/// `%g`, by its precision and the decimal exponent of the value.
pub(super) fn general(precision: Option<u32>, exponent: i32) -> u32 {
    let digits = 130 * precision.unwrap_or(6).saturating_sub(6);
    let decades = exponent.unsigned_abs();
    let steps = if exponent < 0 { 0 } else { decades.min(9) };
    2890 + digits + 290 * steps + 55 * steps * steps + (decades - steps) * if exponent < 0 { 45 } else { 95 }
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
        assert!(*most < 0.17, "{most} {case}");
    }

    #[test]
    fn printing_costs_about_what_the_board_spends() {
        let errors = errors("printf", |text| 367 + 133 * text.len() as u32);
        assert!(errors.len() > 10, "{}", errors.len());
        let (median, case) = &errors[errors.len() / 2];
        assert!(*median < 0.02, "{median} {case}");
    }
}
