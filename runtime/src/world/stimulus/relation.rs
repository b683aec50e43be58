//! Relations between two numbers.

/// A relation between two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Equal, or within the tolerance.
    Equal,
    /// Not equal.
    Different,
    /// Below it.
    Less,
    /// Above it.
    Greater,
    /// Not above it.
    LessOrEqual,
    /// Not below it.
    GreaterOrEqual,
}

impl Relation {
    /// Returns its sign.
    pub(super) const fn sign(self) -> &'static str {
        match self {
            Self::Equal => "=",
            Self::Different => "!=",
            Self::Less => "<",
            Self::Greater => ">",
            Self::LessOrEqual => "<=",
            Self::GreaterOrEqual => ">=",
        }
    }

    /// Returns whether a value is in this relation to a number.
    pub(super) fn holds(self, value: f64, number: f64, tolerance: f64) -> bool {
        match self {
            Self::Equal => (value - number).abs() <= tolerance,
            Self::Different => !Self::Equal.holds(value, number, tolerance),
            Self::Less => value < number,
            Self::Greater => value > number,
            Self::LessOrEqual => value <= number,
            Self::GreaterOrEqual => value >= number,
        }
    }
}
