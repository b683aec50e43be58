//! Firmware variables, structures with their fields, and constants of the header.

use std::fmt::Write as _;

use kmotiondef::headers::EMBEDDED;
use kmotiondef::start::{StartValue, StoreCondition};
use kmotiondef::structs::{STRUCTURES, Structure, StructureField};
use kmotiondef::variables::FIRMWARE_VARIABLES;

use super::ExplainedName;

/// Each variable, field and constant with its meaning.
pub(super) fn entries() -> Vec<ExplainedName> {
    let variables =
        FIRMWARE_VARIABLES.iter().map(|row| ExplainedName { name: row.name, about: on_a_line(row.doc) });
    let fields = STRUCTURES.iter().flat_map(|structure| {
        structure.fields.iter().map(|field| ExplainedName {
            name: field.name,
            about: format!("{}: {}", structure.name, on_a_line(field.doc)),
        })
    });
    let structures =
        STRUCTURES.iter().map(|row| ExplainedName { name: row.name, about: "A structure.".to_owned() });
    let constants = constants().map(|(name, value)| ExplainedName { name, about: value.to_owned() });
    variables.chain(fields).chain(structures).chain(constants).collect()
}

/// Every variable with its meaning.
pub(super) fn variables() -> String {
    FIRMWARE_VARIABLES.iter().fold(String::new(), |mut rows, row| {
        let _ = writeln!(rows, "  {:<40}{}", row.ty.declare(row.name), on_a_line(row.doc));
        rows
    })
}

/// Explains variables, structures, fields and constants with a name.
pub(super) fn answer(is_meant: &dyn Fn(&str) -> bool) -> Option<String> {
    let mut parts = Vec::new();
    for row in FIRMWARE_VARIABLES.iter().filter(|row| is_meant(row.name)) {
        let declaration = row.ty.declare(row.name);
        let start = start(row.start, row.stored);
        parts.push(format!("# {}\n\n    {declaration};\n\n{}\n{start}", row.name, on_a_line(row.doc)));
    }
    for structure in STRUCTURES {
        if is_meant(structure.name) {
            parts.push(fields(structure));
        }
        for row in structure.fields.iter().filter(|row| is_meant(row.name)) {
            parts.push(field(structure, row));
        }
    }
    for (name, value) in constants().filter(|(name, _)| is_meant(name)) {
        parts.push(format!("# {name}\n\n    #define {name} {value}\n{}", used_by(name)));
    }
    (!parts.is_empty()).then(|| parts.join("\n"))
}

fn field(structure: &Structure, row: &StructureField) -> String {
    let access = match structure.name {
        "CHAN" => format!("    ch0->{0}, chan[0].{0}: {1}\n", row.name, row.ty),
        "PERSIST" => format!("    persist.{}: {}\n", row.name, row.ty),
        _ => format!("    {}\n", row.ty.declare(row.name)),
    };
    let start = start(row.start, row.stored);
    let modes = modes(row.name);
    format!("# {} of {}\n\n{access}\n{}\n{start}{modes}", row.name, structure.name, on_a_line(row.doc))
}

/// A structure as a list of its fields.
fn fields(structure: &Structure) -> String {
    let mut text = format!("# {}\n\n{} bytes\n\n", structure.name, structure.size);
    for field in structure.fields {
        let _ = writeln!(text, "  {:<28}{}", field.ty.declare(field.name), on_a_line(field.doc));
    }
    text
}

/// The value at power-up, if it is a number.
fn start(start: StartValue, stored: StoreCondition) -> String {
    let value = match start {
        StartValue::Zero => "0".to_owned(),
        StartValue::Int(value) | StartValue::Each(value) => value.to_string(),
        StartValue::Float(value) => value.to_string(),
        StartValue::Double(value) => value.to_string(),
        StartValue::Text(text) => format!("\"{text}\""),
        StartValue::PerAxis { first: 0, step: 1 } => "the number of the axis".to_owned(),
        StartValue::PerAxis { first, step } if first < 2 => {
            format!("{step} times the number of the axis, plus {first}")
        }
        StartValue::PerAxis { .. } | StartValue::Address(_) | StartValue::Words(_) | StartValue::Fields => {
            return String::new();
        }
    };
    let kept = match stored {
        StoreCondition::Always => "at every power-up",
        StoreCondition::UnlessFlashed => "at power-up, unless `Flash` has kept another value",
    };
    format!("It is {value} {kept}.\n")
}

/// The constants for a field with modes.
fn modes(field: &str) -> String {
    let suffix = match field {
        "InputMode" | "OutputMode" => "_MODE",
        "BacklashMode" => "BACKLASH_",
        _ => return String::new(),
    };
    let is_one = |name: &str| match field {
        "BacklashMode" => name.starts_with(suffix),
        "InputMode" => name.ends_with(suffix) && modes_of_input().contains(&name),
        _ => name.ends_with(suffix) && !modes_of_input().contains(&name),
    };
    let rows: Vec<_> = constants().filter(|(name, _)| is_one(name)).collect();
    rows.iter().fold("\n".to_owned(), |mut text, (name, value)| {
        let _ = writeln!(text, "  {name:<22}{value}");
        text
    })
}

/// The first five modes in the headers are input modes; the numbers of output modes begin at 0 again.
fn modes_of_input() -> Vec<&'static str> {
    let all = constants().filter(|(name, _)| name.ends_with("_MODE"));
    let mut names: Vec<_> =
        all.skip_while(|(name, _)| *name != "NO_INPUT_MODE").map(|(name, _)| name).collect();
    let end = names.iter().position(|name| *name == "NO_OUTPUT_MODE").unwrap_or(names.len());
    names.truncate(end);
    names
}

/// Returns the field for a mode.
fn used_by(name: &str) -> String {
    ["InputMode", "OutputMode", "BacklashMode"]
        .into_iter()
        .find(|field| modes(field).split_whitespace().any(|word| word == name))
        .map(|field| format!("\nA value of `{field}`.\n"))
        .unwrap_or_default()
}

/// The constants of the board's headers with the rest of their lines.
fn constants() -> impl Iterator<Item = (&'static str, &'static str)> {
    let texts = EMBEDDED.iter().map(|(_, text)| std::str::from_utf8(text).unwrap_or_default());
    texts.flat_map(str::lines).filter_map(|line| {
        let (name, value) = line.strip_prefix("#define ")?.split_once(' ')?;
        (!name.contains('(') && !value.trim().is_empty()).then(|| (name, value.trim()))
    })
}

fn on_a_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
