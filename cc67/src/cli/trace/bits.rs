//! Changes of bits as a table: `time_ns,bit,value,thread`, thread 0 for what no thread did.

use std::fmt::Write as _;

use super::{Log, nanoseconds};

/// The table.
pub(super) fn text(log: &Log) -> String {
    let mut changes = log.changes.clone();
    changes.sort_by_key(|change| change.at);
    changes.iter().fold("time_ns,bit,value,thread\n".to_owned(), |mut text, change| {
        let (value, thread) = (u8::from(change.level), change.thread.map_or(0, |thread| thread.get()));
        let _ = writeln!(text, "{},{},{value},{thread}", nanoseconds(change.at), change.bit);
        text
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_change_is_a_line() {
        assert_eq!(super::text(&super::super::testing::log()), "time_ns,bit,value,thread\n215000,46,0,1\n");
    }
}
