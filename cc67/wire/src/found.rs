//! A board that is connected.

/// A board that was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundBoard {
    /// Its address, for `--on`.
    pub address: String,
    /// Its name, as it calls itself.
    pub name: String,
    /// Its serial number at USB.
    pub serial: Option<String>,
    /// The driver or program that holds it.
    pub holder: Option<String>,
}
