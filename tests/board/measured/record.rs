//! The record that a program leaves in the gather buffer: its observations slice by slice, and the final values.

use cc67::record::{PATH, PATH_VARIABLES, PRECISION, SAMPLES, STATES};
use cc67_host::Session;
use cc67_host::target::Target;
use kmotiondef::structs::Chan;
use kmotiondef::variables::variable_named;
use kmotiondef::{CType, GuestAddr};
use serde_json::Value as Json;
use vm::memory::Scalar;

/// Columns that are floats in memory.
const SINGLES: [&str; 4] = ["ch0->Output", "ch0->integrator", "ch0->Backlash", "ch0->x1last"];

/// A value, and whether it is a float.
struct Value {
    value: f64,
    is_single: bool,
}

impl Value {
    /// Returns whether it equals the recorded value: exactly if it is an integer or a float.
    fn is(&self, recorded: &Json) -> bool {
        let Some(recorded) = recorded.as_f64() else { return self.value.is_nan() };
        if self.is_single {
            return self.value as f32 == recorded as f32;
        }
        (self.value - recorded).abs() <= PRECISION * recorded.abs().max(1.0)
    }
}

/// The values that a program has left in the gather buffer.
pub(super) struct Record<'s, T> {
    session: &'s Session<T>,
    begin: GuestAddr,
}

impl<'s, T: Target> Record<'s, T> {
    /// The record of a program that has ended.
    pub(super) fn new(session: &'s Session<T>) -> Self {
        let pointer = variable_named("gather_buffer").expect("the board has one").address;
        let begin = GuestAddr::new(session.peek_object(pointer));
        Self { session, begin }
    }

    fn word<S: Scalar>(&self, index: u32) -> S {
        self.session.peek_object(self.begin.offset(4 * index))
    }

    /// A final value, by its name in the file.
    fn at_end(&self, name: &str) -> Value {
        if let Some(index) = (0..).zip(PATH_VARIABLES).find(|(_, known)| *known == name) {
            return Value { value: self.word(PATH + 2 * index.0), is_single: false };
        }
        if let Some(index) = name.strip_prefix("persist.UserData[") {
            let index = index.trim_end_matches(']').parse().expect(name);
            let value = self.session.user_data(index).expect("an element");
            return Value { value: f64::from(value), is_single: false };
        }
        let (axis, field) = name.strip_prefix("chan[").and_then(|rest| rest.split_once("].")).expect(name);
        let axis: u32 = axis.parse().expect(name);
        if field == "pcoeff-c" {
            return Value { value: f64::from(self.word::<i32>(STATES + axis)), is_single: false };
        }
        let (offset, ty) = place(field);
        let word = (axis * Chan::STRUCTURE.size + offset) / 4;
        let is_single = ty == CType::Float;
        let value = match ty {
            CType::Float => f64::from(self.word::<f32>(word)),
            CType::Double => self.word(word),
            _ => f64::from(self.word::<i32>(word)),
        };
        Value { value, is_single }
    }

    /// Adds the differences from a row.
    pub(super) fn compare(&self, row: &Json, found: &mut Vec<String>) {
        let columns: Vec<_> =
            row["columns"].as_array().into_iter().flatten().filter_map(Json::as_str).skip(1).collect();
        for sample in row["rows"].as_array().into_iter().flatten() {
            let slice = sample[0].as_u64().expect("a number");
            // Not all samples stored by a program were recorded.
            let first = SAMPLES + 2 * (slice / samples_every(row)) as u32 * columns.len() as u32;
            let recorded = sample.as_array().into_iter().flatten().skip(1);
            for ((column, recorded), at) in columns.iter().zip(recorded).zip((first..).step_by(2)) {
                let value = Value { value: self.word(at), is_single: SINGLES.contains(column) };
                if !value.is(recorded) {
                    found.push(format!("slice {slice} {column}: {:?}, recorded {recorded}", value.value));
                }
            }
        }
        for (name, recorded) in row["at_end"].as_object().into_iter().flatten() {
            let value = self.at_end(name);
            if !value.is(recorded) {
                found.push(format!("at the end {name}: {:?}, recorded {recorded}", value.value));
            }
        }
        let words = row["gather_words_hex"].as_array().into_iter().flatten().filter_map(Json::as_str);
        for (index, recorded) in (0..).zip(words) {
            let word = format!("{:08X}", self.word::<u32>(index));
            if word != recorded {
                found.push(format!("word {index}: {word}, recorded {recorded}"));
            }
        }
    }
}

/// The number of slices between two samples of a program: it stores one where `n%COUNT==0`.
fn samples_every(row: &Json) -> u64 {
    let (_, rest) = row["program"].as_str().and_then(|text| text.rsplit_once("n%")).expect("it samples");
    rest.split("==").next().and_then(|count| count.parse().ok()).expect("a count")
}

/// The offset of a field in the structure of an axis, and its type; `iir[1][5]` is a word of a filter.
fn place(name: &str) -> (u32, CType) {
    if let Some(filter) = name.strip_prefix("iir[") {
        let (filter, word) = filter.trim_end_matches(']').split_once("][").expect(name);
        let filter = Chan::IIR.element(filter.parse().expect(name)).offset();
        return (filter + 4 * word.parse::<u32>().expect(name), CType::Float);
    }
    let field = Chan::STRUCTURE.fields.iter().find(|field| field.name == name).expect(name);
    (field.offset, field.ty)
}
