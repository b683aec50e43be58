//! A board that was found.

/// A board that was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundBoard {
    /// Its address, for `--on`.
    pub address: String,
    /// Its name, as reported by the board.
    pub name: String,
    /// Its USB serial number.
    pub serial: Option<String>,
    /// The driver or program that uses it.
    pub holder: Option<String>,
}
