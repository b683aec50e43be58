//! Texts of `printf` and results of `sscanf`.

use serde_json::Value as Json;

use super::super::{Program, Released, number, report, rows, text, thread};
use super::firmware_5;

/// The number of calls in a program.
const CALLS: usize = 50;
/// The size of each text in bytes.
const BYTES: usize = 256;
/// The number of characters of one call that reach the console.
const SEEN: usize = 128;
/// The maximum number of ticks for a program.
const LONGEST: u32 = 20_000;

/// A call in which numbers outside the range of `int` are replaced by the constants that the vendor's compiler makes of
/// them.
fn folded(call: &str) -> String {
    ["(int)1e20", "(int)-1e20", "(int)2147483648.0"]
        .iter()
        .fold(call.to_owned(), |call, number| call.replace(number, "(int)0x80000000"))
}

/// A program with the calls of some rows.
fn source(rows: &[Json]) -> String {
    let mut source = format!(
        "char out[{CALLS}][{BYTES}];\nint result[{CALLS}], first[{CALLS}], second[{CALLS}];\nint at[3], other[4];\n\
         #define i0 at[0]\n#define i1 at[2]\nmain()\n{{\n"
    );
    for (index, row) in rows.iter().enumerate() {
        // A conversion without an argument takes those of this call.
        source += match row["printf"].is_null() {
            false => "  sprintf(other, \"\", 0, 0, 0, 0, 0, 0);\n",
            true => "  sscanf(\"\", \"\", other, other, other, other);\n",
        };
        source += &match row["printf"].as_str() {
            Some(call) => format!("  sprintf(out[{index}], {});\n", folded(call)),
            None => format!(
                "  i0 = i1 = -99;\n  result[{index}] = sscanf({}, {});\n  first[{index}] = i0; second[{index}] = i1;\n",
                text(&row["text"]),
                text(&row["sscanf"])
            ),
        };
    }
    source + "  persist.UserData[9] = 1;\n}\n"
}

fn check(row: &Json, index: usize, board: &Released, program: &Program) -> Option<String> {
    let memory = board.board.memory();
    if let Some(call) = row["printf"].as_str() {
        let at = program.variable("out").offset((index * BYTES) as u32);
        let mut found = memory.read_c_string(at, BYTES as u32).expect("mapped").to_vec();
        found.truncate(SEEN);
        let found = String::from_utf8_lossy(&found).into_owned();
        return (found != text(&row["out"]))
            .then(|| format!("printf({call}): {found:?}, recorded {}", row["out"]));
    }
    let names = [("result", "result"), ("first", "i0"), ("second", "i1")];
    let found = names.map(|(name, _)| memory.peek::<i32>(program.variable(name).offset(4 * index as u32)));
    let expect = names.map(|(_, name)| number(&row[name]) as i32);
    (found != expect)
        .then(|| format!("sscanf({}, {}): {found:?}, recorded {expect:?}", row["text"], row["sscanf"]))
}

#[test]
fn texts_of_firmware_5_are_as_recorded() {
    let Some(board) = firmware_5() else { return };
    let rows = rows("fw5-text.jsonl");
    let mut wrong = Vec::new();
    for rows in rows.chunks(CALLS) {
        let mut board = board.clone();
        let program = board.load(thread(1), &source(rows));
        board.run_threads(&[thread(1)], LONGEST);
        wrong.extend(rows.iter().enumerate().filter_map(|(index, row)| check(row, index, &board, &program)));
    }
    report(&wrong, rows.len());
}
