//! The table, compared row by row with the published list of instructions in `tests/data`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use c67x::{Field, Isa, Kind, OffsetKind, Op, Timing};

/// One line of the list: column name to text.
type Line = BTreeMap<String, String>;

fn published() -> Vec<Line> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/instructions.csv");
    let text = fs::read_to_string(path).expect("the list");
    let mut lines = text.lines().map(cells);
    let head = lines.next().expect("names of columns");
    lines.map(|cells| head.iter().cloned().zip(cells).collect()).collect()
}

/// The cells of a line; a cell in quotes may contain commas.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            other => cells.last_mut().expect("one cell").push(other),
        }
    }
    cells
}

/// The list distinguishes the disputed forms only by their ids.
fn id(op: Op) -> String {
    let id = op.id();
    match id.as_str() {
        "NOP.-.n" => id,
        "IDLE.-.none" => "IDLE.-.-".to_owned(),
        _ => id,
    }
}

fn kind_name(kind: Kind) -> &'static str {
    match kind {
        Kind::R => "r",
        Kind::Xr => "xr",
        Kind::L => "l",
        Kind::D => "d",
        Kind::Xd => "xd",
        Kind::Dodd => "dodd",
        Kind::C5 => "c5",
        Kind::U5 => "u5",
        Kind::U4 => "u4",
        Kind::C16 => "c16",
        Kind::H16 => "h16",
        Kind::Disp => "disp",
        Kind::Count => "nop",
        Kind::R2 => "r2",
        Kind::Cr => "cr",
        Kind::Crw => "crw",
        other => panic!("{other:?} has no name in the list"),
    }
}

/// The fields of a row in the notation of the list, in any order.
fn fields(op: Op) -> BTreeSet<String> {
    let row = op.row();
    let mut fields = BTreeSet::new();
    let mut add = |text: String| fields.insert(text);
    for (field, kind) in row.operands {
        match (field, kind) {
            (_, Kind::Irp | Kind::Nrp) => {}
            (Field::Mem, Kind::PosU15) => {
                add("off:8:15:u15".to_owned());
                add("y:7:1:b14".to_owned());
            }
            (Field::Mem, kind) => {
                let offset = kind.mode().expect("an address").offset;
                let name = if offset == OffsetKind::Reg { "br" } else { "u5" };
                add("base:18:5:b".to_owned());
                add(format!("off:13:5:{name}"));
                add("y:7:1:yside".to_owned());
            }
            (_, Kind::Dodd) => {
                add("src2:18:5:dodd".to_owned());
                add("src1:13:5:deven".to_owned());
            }
            (field, kind) => {
                let width = match kind {
                    Kind::C16 | Kind::H16 => 16,
                    Kind::Disp => 21,
                    Kind::Count => 4,
                    _ => 5,
                };
                let name = format!("{field:?}").to_lowercase();
                add(format!("{name}:{}:{width}:{}", field.lowest_bit(), kind_name(*kind)));
            }
        }
    }
    if row.operands.iter().any(|(_, kind)| kind.may_cross()) {
        add("x:12:1:x".to_owned());
    }
    if row.unit.is_some() && row.mask & 2 == 0 {
        add("s:1:1:side".to_owned());
    }
    fields
}

/// The order of the operands in the notation of the list.
fn syntax(op: Op) -> String {
    let names = op.row().operands.iter().map(|(field, kind)| match (field, kind) {
        (_, Kind::Irp) => "irp".to_owned(),
        (_, Kind::Nrp) => "nrp".to_owned(),
        (Field::Mem, Kind::PosU15) => "*+b14/b15[off]".to_owned(),
        (Field::Mem, kind) => {
            let mode = kind.mode().expect("an address");
            let sign = if mode.negative { "-" } else { "+" };
            match mode.update {
                c67x::Update::None => format!("*{sign}base[off]"),
                c67x::Update::Before => format!("*{sign}{sign}base[off]"),
                c67x::Update::After => format!("*base{sign}{sign}[off]"),
            }
        }
        (field, _) => format!("{field:?}").to_lowercase(),
    });
    names.collect::<Vec<_>>().join(",")
}

/// Reads and writes in the notation of the list.
fn stages(timing: Timing) -> (&'static str, &'static str) {
    match timing {
        Timing::Single => ("E1", "E1"),
        Timing::Product => ("E1", "E2"),
        Timing::Four => ("E1", "E4"),
        Timing::Widening => ("E1", "lo E4; hi E5"),
        Timing::DoubleSum => ("lo E1; hi E2", "lo E6; hi E7"),
        Timing::DoubleCompare => ("lo E1; hi E2", "E2"),
        Timing::DoubleMove => ("E1", "lo E1; hi E2"),
        Timing::LongProduct => ("E1-E4", "E9"),
        Timing::WideProduct => ("E1-E4", "lo E9; hi E10"),
        Timing::DoubleProduct => ("src1 lo E1 E2, hi E3 E4; src2 lo E1 E3, hi E2 E4", "lo E9; hi E10"),
        Timing::MixedProduct => ("src1 E1 E2; src2 lo E1, hi E2", "lo E6; hi E7"),
        Timing::SingleProduct => ("E1", "lo E4; hi E5"),
        Timing::Load => ("address E1", "E5; base update E1"),
        Timing::Store => ("address, data E1", "memory E3; base update E1"),
        Timing::Branch => ("E1", "target executes 6 cycles later"),
        Timing::Nothing => ("-", "-"),
    }
}

fn long(op: Op) -> String {
    let has = |written: bool| {
        op.row().operands.iter().any(|(field, kind)| *kind == Kind::L && field.is_written() == written)
    };
    let source = if has(false) { "s" } else { "" };
    let destination = if has(true) { "d" } else { "" };
    format!("{source}{destination}")
}

fn cross(op: Op) -> String {
    let crossing = op.row().operands.iter().find(|(_, kind)| kind.may_cross());
    crossing.map(|(field, _)| format!("{field:?}").to_lowercase()).unwrap_or_default()
}

#[test]
fn every_row_is_as_published() {
    let published: BTreeMap<String, Line> =
        published().into_iter().map(|line| (line["id"].clone(), line)).collect();
    assert_eq!(published.len(), 302);
    assert_eq!(Op::ALL.len(), 302);
    for op in Op::ALL {
        let row = op.row();
        let id = id(*op);
        let line = published.get(&id).unwrap_or_else(|| panic!("{id} is not in the list"));
        let hex = |column: &str| u32::from_str_radix(&line[column], 16).expect("a word");
        assert_eq!(line["mnemonic"], row.mnemonic.name(), "{id}");
        assert_eq!((hex("mask"), hex("value")), (row.mask, row.value), "{id}");
        let wanted: BTreeSet<String> =
            line["fields"].split(';').filter(|part| !part.is_empty()).map(str::to_owned).collect();
        assert_eq!(wanted, fields(*op), "{id}");
        assert_eq!(line["syntax"], syntax(*op), "{id}");
        assert_eq!(line["delay_slots"], row.timing.delay_slots().to_string(), "{id}");
        assert_eq!(line["fu_latency"], row.timing.stages().unit.to_string(), "{id}");
        assert_eq!((line["reads"].as_str(), line["writes"].as_str()), stages(row.timing), "{id}");
        assert_eq!(line["long"], long(*op), "{id}");
        assert_eq!(line["cross"], cross(*op), "{id}");
        assert_eq!(line["isa"] == "C67x+", row.isa == Isa::Plus, "{id}");
        assert!(!row.meaning.is_empty(), "{id}");
    }
}

#[test]
fn no_word_decodes_to_two_forms() {
    for (index, one) in Op::ALL.iter().enumerate() {
        for other in &Op::ALL[index + 1..] {
            let (a, b) = (one.row(), other.row());
            let common = a.mask & b.mask;
            let distinct = a.value & common != b.value & common;
            // NOP 16 would be IDLE; the field of NOP ends at 9.
            let idle = *one == Op::Nop && *other == Op::Idle;
            assert!(distinct || idle, "{} and {}", one.id(), other.id());
        }
    }
}
