//! Samples as a table: the time in seconds, then the items; a line for each sampled tick.

use std::fmt::Write as _;

use kmotiondef::{Cycles, Ticks};

use super::Log;

/// The table up to a tick. Samples are recorded when they change; between them the last one holds.
pub(super) fn text(log: &Log, every: u64, end: Ticks) -> String {
    let columns = log.columns();
    let mut text = "time".to_owned();
    for (_, quantity) in &columns {
        let _ = write!(text, ",{}", field(&quantity.to_string()));
    }
    text.push('\n');
    let mut samples = log.samples.iter().peekable();
    let mut values: Option<&[f64]> = None;
    let mut tick = every;
    while tick <= end.get() {
        let now = Cycles::new((tick as i64).saturating_mul(Cycles::PER_TICK.get()));
        while let Some((_, sample)) = samples.next_if(|(at, _)| *at <= now) {
            values = Some(sample);
        }
        if let Some(values) = values {
            let _ = write!(text, "{:.6}", now.get() as f64 / Cycles::PER_SECOND.get() as f64);
            for (index, _) in &columns {
                let _ = write!(text, ",{}", values.get(*index).copied().unwrap_or_default());
            }
            text.push('\n');
        }
        tick += every;
    }
    text
}

/// A name as a field of the table: in quotes if it has a comma or quotes.
fn field(name: &str) -> String {
    if name.contains([',', '"']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    use kmotiondef::Ticks;

    #[test]
    fn a_sample_holds_until_the_next() {
        let text = super::text(&super::super::testing::log(), 2, Ticks::new(7));
        assert_eq!(text, "time,dest0,bit46\n0.000180,0.5,1\n0.000360,0.5,1\n0.000540,2,0\n");
    }
}
