//! Times in options.

/// The board time after which a run without `--for` ends, in seconds.
pub(crate) const DEFAULT_LIMIT: f64 = 60.0;

/// Reads a number of seconds.
pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds >= 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("not a number of seconds".to_owned()),
    }
}
