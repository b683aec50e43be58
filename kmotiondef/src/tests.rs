//! Reads the tables of the specification for the tests of this crate.

use std::collections::BTreeMap;
use std::path::Path;

/// A row, with its cells by the names of the columns.
pub(crate) type Row = BTreeMap<String, String>;

/// All rows of a table of `tests/data/api`.
pub(crate) fn table(name: &str) -> Vec<Row> {
    read(&Path::new("api").join(name))
}

/// All rows of a table for a board other than the default one.
pub(crate) fn table_of(board: &str, name: &str) -> Vec<Row> {
    read(&Path::new("boards").join(board).join(name))
}

fn read(name: &Path) -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data").join(name);
    let text = std::fs::read_to_string(&path).expect("the copies of the tables are in the repository");
    let mut lines = text.lines().map(cells);
    let header = lines.next().expect("the first line names the columns");
    lines.map(|cells| header.iter().cloned().zip(cells).collect()).collect()
}

/// The cells of a line; cells that contain commas or quotes are quoted.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut is_quoted = false;
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        let cell = cells.last_mut().expect("there is one from the start");
        match character {
            '"' if is_quoted && characters.peek() == Some(&'"') => cell.extend(characters.next()),
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            _ => cell.push(character),
        }
    }
    cells
}
