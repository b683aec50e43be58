//! What programs may ask the PC for: the numbers of the requests, and how they are shown.

/// The parameter of a request that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// None.
    Nothing,
    /// The first one, a whole number.
    Whole,
    /// The first one, a single.
    Single,
    /// None here: what is done shows more than a number.
    Elsewhere,
}

use Shown::{Elsewhere, Nothing, Single, Whole};

/// Number, name and shown parameter of every request. Source: gather-persist-console.md section 8.
const REQUESTS: &[(i32, &str, Shown)] = &[
    (1, "emergency stop", Nothing),
    (2, "halt the job", Nothing),
    (3, "execute the job", Nothing),
    (4, "single step", Nothing),
    (5, "feed override", Elsewhere),
    (6, "feed override", Elsewhere),
    (7, "set display X", Single),
    (8, "set display Y", Single),
    (9, "set display Z", Single),
    (10, "set display A", Single),
    (11, "set display B", Single),
    (12, "set display C", Single),
    (13, "user button", Whole),
    (14, "M code", Whole),
    (15, "message box", Elsewhere),
    (16, "get G-code variables from", Whole),
    (17, "set G-code variables from", Whole),
    (18, "MDI", Elsewhere),
    (19, "get resolutions", Nothing),
    (20, "restart the job", Nothing),
    (21, "set spindle override", Single),
    (22, "change spindle override by", Single),
    (23, "get length of tool", Whole),
    (24, "set length of tool", Whole),
    (25, "get settings", Nothing),
    (26, "get machine coordinates", Nothing),
    (27, "get displays", Nothing),
    (28, "update fixture", Nothing),
    (29, "input box", Elsewhere),
    (30, "get diameter of tool", Whole),
    (31, "set diameter of tool", Whole),
    (32, "get X offset of tool", Whole),
    (33, "set X offset of tool", Whole),
    (34, "get Y offset of tool", Whole),
    (35, "set Y offset of tool", Whole),
    (36, "halt at the next line", Nothing),
    (37, "enable jog keys", Nothing),
    (38, "disable jog keys", Nothing),
    (39, "reload geometric correction", Nothing),
    (40, "get jog override X", Nothing),
    (41, "get jog override Y", Nothing),
    (42, "get jog override Z", Nothing),
    (43, "get jog override A", Nothing),
    (44, "get jog override B", Nothing),
    (45, "get jog override C", Nothing),
    (46, "set jog override X", Single),
    (47, "set jog override Y", Single),
    (48, "set jog override Z", Single),
    (49, "set jog override A", Single),
    (50, "set jog override B", Single),
    (51, "set jog override C", Single),
    (52, "recreate the dialog", Nothing),
    (53, "get the text of cell", Whole),
    (54, "rapid override", Elsewhere),
    (55, "rapid override", Elsewhere),
];

/// How a request is shown, by its number and first parameter; `None` if what is done shows more.
pub(super) fn shown(code: i32, parameter: i32) -> Option<String> {
    let Some((_, name, shown)) = REQUESTS.iter().find(|(number, ..)| *number == code) else {
        return Some(format!("request {code} is unknown"));
    };
    match shown {
        Elsewhere => None,
        Nothing => Some((*name).to_owned()),
        Whole => Some(format!("{name} {parameter}")),
        Single => Some(format!("{name} {}", f32::from_bits(parameter.cast_unsigned()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_request_has_its_row() {
        let numbers: Vec<i32> = REQUESTS.iter().map(|(number, ..)| *number).collect();
        assert_eq!(numbers, (1..=55).collect::<Vec<_>>());
        assert_eq!(shown(9, 1.5_f32.to_bits().cast_signed()).as_deref(), Some("set display Z 1.5"));
        assert_eq!(shown(15, 0), None);
        assert_eq!(shown(56, 0).as_deref(), Some("request 56 is unknown"));
    }
}
