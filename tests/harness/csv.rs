//! Tables of comma-separated values, the format of the interface tables.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A row: column name to field.
pub type Row = BTreeMap<String, String>;

/// Reads a table whose first line contains the column names.
#[must_use]
pub fn read(path: &Path) -> Vec<Row> {
    let text = fs::read_to_string(path).expect("the table is there");
    let mut rows = records(&text).into_iter();
    let columns = rows.next().expect("the table has a first line");
    rows.map(|fields| columns.iter().cloned().zip(fields).collect()).collect()
}

/// Splits text into records of fields; a quoted field may contain commas and doubled quotes.
fn records(text: &str) -> Vec<Vec<String>> {
    let mut records = vec![vec![String::new()]];
    let mut quoted = false;
    let mut characters = text.trim_end().chars().peekable();
    while let Some(character) = characters.next() {
        let record = records.last_mut().expect("there is always a record");
        let field = record.last_mut().expect("there is always a field");
        match character {
            '"' if quoted && characters.peek() == Some(&'"') => {
                field.push('"');
                characters.next();
            }
            '"' => quoted = !quoted,
            ',' if !quoted => record.push(String::new()),
            '\n' if !quoted => records.push(vec![String::new()]),
            '\r' if !quoted => {}
            _ => field.push(character),
        }
    }
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quoted_fields_may_contain_commas_and_doubled_quotes() {
        assert_eq!(records("a,\"b,\"\"c\"\"\"\nd,\n"), [["a", "b,\"c\""], ["d", ""]]);
    }
}
