//! The profile as a flame graph: a picture in which widths are processor time.
//!
//! A thread nearly always waits, and its waits would leave no room for its computations: only the table contains them.

use anyhow::{Context, Result};
use inferno::flamegraph::{self, Options};

use super::Account;

/// Cycles per microsecond.
const CYCLES_PER_US: i64 = 200;

/// Draws the profile; the tower of each thread contains its functions and lines.
pub(super) fn draw(account: &Account) -> Result<Vec<u8>> {
    let lines = folded_stacks(account);
    let mut options = Options::default();
    options.title = "Processor time".to_owned();
    options.count_name = "µs".to_owned();
    options.deterministic = true;
    let mut picture = Vec::new();
    flamegraph::from_lines(&mut options, lines.iter().map(String::as_str), &mut picture)
        .context("there is nothing to draw: no program spent any time")?;
    Ok(picture)
}

/// `thread 1;main;work count` for each position, in the format of flame graph tools.
fn folded_stacks(account: &Account) -> Vec<String> {
    let mut lines = Vec::new();
    for (place, spent) in account {
        let mut tower = vec![place.whose.to_string()];
        tower.extend(place.frames.iter().map(|frame| match frame.line {
            Some(line) => format!("{}:{line}", frame.function),
            None => frame.function.clone(),
        }));
        tower.extend(place.firmware.clone());
        // Widths are whole microseconds; shorter times are not visible in a picture.
        let cycles = spent.computing.get();
        if cycles >= CYCLES_PER_US {
            lines.push(format!("{} {}", tower.join(";"), cycles / CYCLES_PER_US));
        }
    }
    lines
}
