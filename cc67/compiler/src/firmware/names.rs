//! The functions and variables of the firmware, for names that a program did not declare.
//!
//! A program that forgot the header, or a declaration, still gets the firmware's own
//! prototype (`dialect.md` 2.3), and a misspelt name gets a suggestion.

use kmotiondef::CType;
use kmotiondef::boards::TargetBoard;
use kmotiondef::firmware::Origin;

/// The prototype of a firmware or library function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prototype {
    /// The type of its result.
    pub result: CType,
    /// The types of its parameters.
    pub parameters: Vec<CType>,
    /// `...` ends the list.
    pub is_variadic: bool,
}

/// The names of the firmware, its header and the library.
pub trait FirmwareNames {
    /// The prototype of a function that a program may call without declaring it.
    fn prototype(&self, name: &str) -> Option<Prototype>;

    /// The origin of a function of this name; `None` if there is none.
    fn origin(&self, name: &str) -> Option<Origin> {
        self.prototype(name).map(|_| Origin::Header)
    }

    /// Reports whether the vendor's header declares a variable or constant of this name.
    fn is_variable(&self, name: &str) -> bool;

    /// Reports whether the firmware uses the name internally: neither a function nor a variable for programs.
    fn is_hidden(&self, _name: &str) -> bool {
        false
    }

    /// Reports whether the vendor's header defines a type of this name.
    fn is_type(&self, name: &str) -> bool;

    /// The board for which programs are compiled; for an unknown firmware, the board whose tables are used instead.
    fn board(&self) -> &'static TargetBoard {
        TargetBoard::default_board()
    }

    /// Every function and variable, for suggestions.
    fn names(&self) -> Box<dyn Iterator<Item = &str> + '_>;
}
