//! A scenario and the firmware's observation as a line of JSON, which tests later compare with the model without the
//! firmware.

use serde_json::{Map, Value as Json, json};

use super::observation::{Difference, Observation};
use super::scenario::Scenario;

/// The number of samples in a vector.
const MOST_SAMPLES: usize = 24;

/// The vector of a scenario: all output of the firmware, a selection of samples with those that differ from the
/// model's, and the final values that differ.
pub(super) fn vector(
    scenario: &Scenario,
    difference: &Difference,
    model: &Observation,
    firmware: &Observation,
) -> Json {
    let mut vector = Map::new();
    let note = format!("{}: {} on the model of that day", difference.what, difference.model);
    if scenario.is_session() {
        let exchange = scenario.lines().zip(&firmware.texts).map(|(line, answer)| json!([line, answer]));
        vector.insert("session".to_owned(), json!(scenario.name));
        vector.insert("exchange".to_owned(), exchange.collect());
        vector.insert("note".to_owned(), json!(note));
        return Json::Object(vector);
    }
    vector.insert("name".to_owned(), json!(scenario.name));
    let programs = scenario.programs();
    let program = match programs.as_slice() {
        [(_, only)] => json!(only),
        several => {
            Json::Object(several.iter().map(|(thread, text)| (thread.to_string(), json!(text))).collect())
        }
    };
    vector.insert("program".to_owned(), program);
    let console: String = firmware.texts.iter().flat_map(|line| [line, "\n"]).collect();
    vector.insert("console".to_owned(), json!(console));
    if !scenario.columns.is_empty() {
        let columns = scenario.columns.iter().map(String::as_str);
        vector.insert("columns".to_owned(), ["n (slice of the loop)"].into_iter().chain(columns).collect());
        vector.insert("rows".to_owned(), rows(scenario, model, firmware));
    }
    let ends = model.different_ends(firmware).map(|end| end.what.trim_start_matches("end ").to_owned());
    let ends: Vec<String> = ends.collect();
    let values = firmware.end.iter().filter(|value| ends.contains(&value.name));
    let at_end: Map<String, Json> = values.map(|value| (value.name.clone(), json!(value.value))).collect();
    if !at_end.is_empty() {
        vector.insert("at_end".to_owned(), Json::Object(at_end));
    }
    vector.insert("note".to_owned(), json!(note));
    Json::Object(vector)
}

/// Samples from the whole run, and the first that differ.
fn rows(scenario: &Scenario, model: &Observation, firmware: &Observation) -> Json {
    let every = firmware.rows.len().div_ceil(MOST_SAMPLES / 2).max(1);
    let pairs = model.rows.iter().zip(&firmware.rows);
    let different: Vec<usize> = pairs
        .enumerate()
        .filter(|(_, (one, two))| one != two)
        .map(|(at, _)| at)
        .take(MOST_SAMPLES / 2)
        .collect();
    let is_kept = |at: usize| at.is_multiple_of(every) || different.contains(&at);
    let rows = firmware.rows.iter().enumerate().filter(|(at, _)| is_kept(*at));
    rows.map(|(at, row)| {
        let slice = json!(at * scenario.samples_every());
        [slice].into_iter().chain(row.iter().map(|value| json!(value))).collect::<Json>()
    })
    .collect()
}
