//! Requests of programs to the PC: their numbers, and the text by which they are shown.

/// The parameter of a request that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ShownParameter {
    /// None.
    Nothing,
    /// The first one, a whole number.
    Whole,
    /// The first one, a single.
    Single,
    /// Not shown here: the action itself shows more than a number.
    Elsewhere,
}

use ShownParameter::{Elsewhere, Nothing, Single, Whole};

/// The direction of a request: it reads a value of the PC or writes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    Get,
    Set,
}

/// The rate that a request overrides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rate {
    Feed,
    Rapid,
}

/// The operation on a rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    To,
    By,
}

/// The PC's action for a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PcAction {
    /// It is shown, no more.
    Show,
    /// Threads 2 to 7 and the path stop.
    EmergencyStop,
    EndJob,
    BeginJob,
    Override(Rate, Change),
    /// Sets the display of an axis.
    Display(usize),
    MessageBox,
    /// Copies #variables.
    Variables(Direction),
    Mdi,
    Resolutions,
    /// An entry of the tool table; its kind is the number of the request that gets it.
    Tool(i32, Direction),
    Settings,
    Displays,
    InputBox,
    /// The jog override of an axis.
    JogOverride(usize, Direction),
    /// The text of a screen cell.
    Cell,
}

use PcAction::{
    BeginJob, Cell, Display, Displays, EmergencyStop, EndJob, InputBox, JogOverride, Mdi, MessageBox,
    Override, Resolutions, Settings, Show, Tool, Variables,
};

/// Number, name, shown parameter and action of every request. Source: gather-persist-console.md section 8.
const REQUESTS: &[(i32, &str, ShownParameter, PcAction)] = &[
    (1, "emergency stop", Nothing, EmergencyStop),
    (2, "halt the job", Nothing, EndJob),
    (3, "execute the job", Nothing, BeginJob),
    (4, "single step", Nothing, Show),
    (5, "feed override", Elsewhere, Override(Rate::Feed, Change::To)),
    (6, "feed override", Elsewhere, Override(Rate::Feed, Change::By)),
    (7, "set display X", Single, Display(0)),
    (8, "set display Y", Single, Display(1)),
    (9, "set display Z", Single, Display(2)),
    (10, "set display A", Single, Display(3)),
    (11, "set display B", Single, Display(4)),
    (12, "set display C", Single, Display(5)),
    (13, "user button", Whole, Show),
    (14, "M code", Whole, Show),
    (15, "message box", Elsewhere, MessageBox),
    (16, "get G-code variables from", Whole, Variables(Direction::Get)),
    (17, "set G-code variables from", Whole, Variables(Direction::Set)),
    (18, "MDI", Elsewhere, Mdi),
    (19, "get resolutions", Nothing, Resolutions),
    (20, "restart the job", Nothing, Show),
    (21, "set spindle override", Single, Show),
    (22, "change spindle override by", Single, Show),
    (23, "get length of tool", Whole, Tool(23, Direction::Get)),
    (24, "set length of tool", Whole, Tool(23, Direction::Set)),
    (25, "get settings", Nothing, Settings),
    (26, "get machine coordinates", Nothing, Displays),
    (27, "get displays", Nothing, Displays),
    (28, "update fixture", Nothing, Show),
    (29, "input box", Elsewhere, InputBox),
    (30, "get diameter of tool", Whole, Tool(30, Direction::Get)),
    (31, "set diameter of tool", Whole, Tool(30, Direction::Set)),
    (32, "get X offset of tool", Whole, Tool(32, Direction::Get)),
    (33, "set X offset of tool", Whole, Tool(32, Direction::Set)),
    (34, "get Y offset of tool", Whole, Tool(34, Direction::Get)),
    (35, "set Y offset of tool", Whole, Tool(34, Direction::Set)),
    (36, "halt at the next line", Nothing, Show),
    (37, "enable jog keys", Nothing, Show),
    (38, "disable jog keys", Nothing, Show),
    (39, "reload geometric correction", Nothing, Show),
    (40, "get jog override X", Nothing, JogOverride(0, Direction::Get)),
    (41, "get jog override Y", Nothing, JogOverride(1, Direction::Get)),
    (42, "get jog override Z", Nothing, JogOverride(2, Direction::Get)),
    (43, "get jog override A", Nothing, JogOverride(3, Direction::Get)),
    (44, "get jog override B", Nothing, JogOverride(4, Direction::Get)),
    (45, "get jog override C", Nothing, JogOverride(5, Direction::Get)),
    (46, "set jog override X", Single, JogOverride(0, Direction::Set)),
    (47, "set jog override Y", Single, JogOverride(1, Direction::Set)),
    (48, "set jog override Z", Single, JogOverride(2, Direction::Set)),
    (49, "set jog override A", Single, JogOverride(3, Direction::Set)),
    (50, "set jog override B", Single, JogOverride(4, Direction::Set)),
    (51, "set jog override C", Single, JogOverride(5, Direction::Set)),
    (52, "recreate the dialog", Nothing, Show),
    (53, "get the text of cell", Whole, Cell),
    (54, "rapid override", Elsewhere, Override(Rate::Rapid, Change::To)),
    (55, "rapid override", Elsewhere, Override(Rate::Rapid, Change::By)),
];

/// Returns whether a text is that of a request that the PC knows.
#[must_use]
pub fn is_request(text: &str) -> bool {
    let is_named = |name: &str| {
        text.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', ':']))
    };
    REQUESTS.iter().any(|(_, name, ..)| is_named(name))
}

/// Returns the text by which a request is shown, by its number and first parameter; `None` if its effect shows more.
pub(super) fn shown(code: i32, parameter: i32) -> Option<String> {
    let Some((_, name, shown, _)) = REQUESTS.iter().find(|(number, ..)| *number == code) else {
        return Some(format!("request {code} is unknown"));
    };
    match shown {
        Elsewhere => None,
        Nothing => Some((*name).to_owned()),
        Whole => Some(format!("{name} {parameter}")),
        Single => Some(format!("{name} {}", f32::from_bits(parameter.cast_unsigned()))),
    }
}

/// Returns the action for a request; `None` for a number that is not one.
pub(super) fn action(code: i32) -> Option<PcAction> {
    REQUESTS.iter().find(|(number, ..)| *number == code).map(|(.., action)| *action)
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
