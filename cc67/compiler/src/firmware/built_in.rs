//! The simulated board's own firmware: everything is read from the tables of `kmotiondef`.

use kmotiondef::ctype::TYPEDEFS;
use kmotiondef::firmware::{ABSENT, FIRMWARE_FUNCTIONS, Origin, function_named};
use kmotiondef::hidden::is_hidden;
use kmotiondef::structs::STRUCTURES;
use kmotiondef::variables::{FIRMWARE_VARIABLES, variable_named};

use super::{FirmwareNames, Prototype};

/// Firmware 4.34 from the built-in tables.
#[derive(Clone, Copy, Debug, Default)]
pub struct BuiltIn;

impl FirmwareNames for BuiltIn {
    fn prototype(&self, name: &str) -> Option<Prototype> {
        let function = FIRMWARE_FUNCTIONS.get(function_named(name)?)?;
        Some(Prototype {
            result: function.result,
            parameters: function.params.iter().map(|parameter| parameter.ty).collect(),
            is_variadic: function.is_variadic,
        })
    }

    fn origin(&self, name: &str) -> Option<Origin> {
        Some(FIRMWARE_FUNCTIONS.get(function_named(name)?)?.origin)
    }

    fn is_variable(&self, name: &str) -> bool {
        variable_named(name).is_some()
    }

    fn is_hidden(&self, name: &str) -> bool {
        is_hidden(name)
    }

    fn is_type(&self, name: &str) -> bool {
        TYPEDEFS.iter().any(|(typedef, _)| *typedef == name)
            || STRUCTURES.iter().any(|structure| structure.name == name)
    }

    fn names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        let functions = FIRMWARE_FUNCTIONS.iter().map(|function| function.name);
        let variables = FIRMWARE_VARIABLES.iter().map(|variable| variable.name);
        Box::new(functions.chain(variables).filter(|name| !ABSENT.contains(name)))
    }
}
