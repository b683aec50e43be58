//! The unit of a watched expression, if it is a single item of the board with a known unit.

use kmotiondef::structs::{Chan, StructureField};
use kmotiondef::variables::FIRMWARE_VARIABLES;
use runtime::trace::{Item, Quantity};

/// The ends of descriptions, and the unit of each.
const UNITS: &[(&str, &str)] = &[
    (", position units.", "units"),
    (", units/s.", "units/s"),
    (", units/s^2.", "units/s²"),
    (", units/s^3.", "units/s³"),
    (", PWM counts.", "counts"),
    (", seconds.", "s"),
    (", seconds a tick.", "s"),
];

/// The unit of a watched quantity; empty for numbers without a unit.
pub(super) fn of(quantity: &Quantity) -> &'static str {
    match quantity {
        Quantity::Item(item) => Item::unit(*item),
        Quantity::Formula(text, _) => of_expression(text),
    }
}

fn of_expression(text: &str) -> &'static str {
    // `2:count` is the `count` of thread 2.
    let place = text.rsplit(':').next().unwrap_or_default().trim();
    let is_place = |character: char| character.is_ascii_alphanumeric() || "_.[]->".contains(character);
    // A minus sign that is not part of an arrow makes the expression a difference.
    if !place.chars().all(is_place) || place.replace("->", ".").contains(['-', '>']) {
        return "";
    }
    let path = place.replace("->", ".");
    match path.rsplit_once('.') {
        Some((axis, field)) if axis.starts_with("ch") => of_field(field),
        Some(_) => "",
        None => {
            let variable = FIRMWARE_VARIABLES.iter().find(|variable| variable.name == path);
            variable.map_or("", |variable| of_meaning(variable.doc))
        }
    }
}

fn of_field(name: &str) -> &'static str {
    let field = Chan::STRUCTURE.fields.iter().find(|field| field.name == name);
    field.map_or("", |StructureField { doc, .. }| of_meaning(doc))
}

fn of_meaning(doc: &str) -> &'static str {
    UNITS.iter().find(|(ending, _)| doc.ends_with(ending)).map_or("", |(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn board_fields_have_their_physical_units() {
        for (text, unit) in [
            ("ch0->Dest", "units"),
            ("chan[3].Vel", "units/s"),
            ("2:chan[i].Jerk", "units/s³"),
            ("ch1->StepperAmplitude", "counts"),
            ("CS0_TimeBaseDelta", "s"),
            ("ch0->P", ""),
            ("ch0->Dest - ch1->Dest", ""),
            ("other.Dest", ""),
            ("count", ""),
        ] {
            assert_eq!(of_expression(text), unit, "{text}");
        }
    }
}
