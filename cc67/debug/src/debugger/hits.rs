//! Conditions on the hit count of a breakpoint.

use std::str::FromStr;

use super::DebugError;

/// A condition on the number of times that a breakpoint was reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitCondition {
    /// From this hit on: `5`, `>= 5`, and `> 4`.
    From(u64),
    /// Only at this hit: `== 5`.
    At(u64),
    /// Up to this hit: `<= 5`, and `< 6`.
    UpTo(u64),
    /// At every multiple: `% 5`.
    Multiple(u64),
}

impl HitCondition {
    /// Reports whether a breakpoint stops at this hit, counted from 1.
    #[must_use]
    pub const fn stops(self, hits: u64) -> bool {
        match self {
            Self::From(first) => hits >= first,
            Self::At(only) => hits == only,
            Self::UpTo(last) => hits <= last,
            Self::Multiple(step) => hits.is_multiple_of(step),
        }
    }
}

impl FromStr for HitCondition {
    type Err = DebugError;

    fn from_str(text: &str) -> Result<Self, DebugError> {
        let text = text.trim();
        let digits = text.trim_start_matches(['=', '<', '>', '%']);
        let sign = &text[..text.len() - digits.len()];
        let wrong = || {
            let forms = "`5`, `>= 5`, `> 4`, `== 5`, `<= 5`, `< 6` and `% 5` are some";
            DebugError(format!("`{text}` is not a condition on the number of hits; {forms}"))
        };
        let number: u64 = digits.trim().parse().map_err(|_| wrong())?;
        match sign {
            "" | ">=" => Ok(Self::From(number)),
            ">" => Ok(Self::From(number.saturating_add(1))),
            "=" | "==" => Ok(Self::At(number)),
            "<=" => Ok(Self::UpTo(number)),
            "<" => Ok(Self::UpTo(number.saturating_sub(1))),
            "%" if number > 0 => Ok(Self::Multiple(number)),
            _ => Err(wrong()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_on_hits_mean_what_they_say() {
        for (text, expect) in [
            ("3", "3456"),
            (">= 3", "3456"),
            ("> 3", "456"),
            ("== 3", "3"),
            ("< 3", "12"),
            ("<=3", "123"),
            (" % 2 ", "246"),
        ] {
            let condition: HitCondition = text.parse().expect(text);
            let stops: String =
                (1..=6).filter(|hits| condition.stops(*hits)).map(|hits| hits.to_string()).collect();
            assert_eq!(stops, expect, "{text}");
        }
        for wrong in ["abc", "", "% 0", "<> 3", "3 4", "-1"] {
            assert!(wrong.parse::<HitCondition>().is_err(), "{wrong}");
        }
    }
}
