//! The boards against the tables of the specification.

use std::collections::BTreeSet;

use super::*;
use crate::map::{KOGNA_PROGRAMS, KOGNA_STACKS_BASE};
use crate::tests::{Row, table_of};
use crate::variables::{chan, trip_coeffs};

const OTHERS: [&str; 2] = ["kflop-5.3.2", "kogna-5.3.2"];

fn board(name: &str) -> &'static TargetBoard {
    TargetBoard::named(name).expect(name)
}

fn hexadecimal_address(address: GuestAddr) -> String {
    format!("0x{:08X}", address.get())
}

#[test]
fn every_function_and_variable_has_the_address_of_the_specification() {
    for name in OTHERS {
        let board = board(name);
        for row in table_of(name, "functions.csv") {
            let known = board.function(&row["name"]);
            if row["address"].is_empty() {
                let is_library = known.is_some_and(|known| known.origin == Origin::Library);
                assert!(is_library || board.function(&row["name"]).is_none(), "{}", row["name"]);
                continue;
            }
            // The tables have no type for `long long`.
            if row["signature"].contains("long long") {
                assert!(board.is_hidden(&row["name"]));
                continue;
            }
            let known = known.unwrap_or_else(|| panic!("{name} lacks {}", row["name"]));
            assert_eq!(hexadecimal_address(known.address), row["address"], "{name}: {}", row["name"]);
            assert_eq!(
                known.origin == Origin::Header,
                row["header_declares"] == "yes",
                "{name}: {}",
                row["name"]
            );
        }
        for row in table_of(name, "variables.csv").iter().filter(|row| !row["address"].is_empty()) {
            let address = board.variable(&row["name"]).map(hexadecimal_address);
            assert_eq!(address.as_ref(), Some(&row["address"]), "{name}: {}", row["name"]);
        }
    }
}

#[test]
fn hidden_names_are_the_other_reserved_names_of_the_specification() {
    for name in OTHERS {
        let board = board(name);
        let rows = table_of(name, "reserved-names.csv");
        assert!(rows.len() > 700, "{name}: {}", rows.len());
        for row in rows {
            let is_known = board.function(&row["name"]).is_some() || board.variable(&row["name"]).is_some();
            let is_listed =
                row["in_functions_or_variables_table"] == "yes" && !row["name"].starts_with("strto");
            assert!(is_known || board.is_hidden(&row["name"]), "{name}: {}", row["name"]);
            assert!(is_known || !is_listed, "{name}: {}", row["name"]);
        }
    }
}

#[test]
fn structures_have_the_layout_of_the_specification() {
    for name in OTHERS {
        let structures = board(name).structures();
        for row in table_of(name, "structs.csv") {
            let find = |row: &Row| structures.iter().find(|structure| structure.name == row["struct"]);
            let structure = find(&row).unwrap_or_else(|| panic!("{name}: {}", row["struct"]));
            if row["field"] == "(struct)" {
                assert_eq!(structure.size.to_string(), row["size"], "{name}: {}", structure.name);
                continue;
            }
            // The fields of nested structures and unions have compound names.
            let Some(field) = structure.fields.iter().find(|field| field.name == row["field"]) else {
                assert!(row["field"].contains('.') || row["field"].contains('('), "{name}: {}", row["field"]);
                continue;
            };
            let place = (field.offset.to_string(), field.size.to_string());
            assert_eq!(place, (row["offset"].clone(), row["size"].clone()), "{name}: {}", row["field"]);
        }
    }
}

#[test]
fn programs_and_variables_of_kogna_lie_where_its_memory_map_has_them() {
    let board = board("kogna-5.3.2");
    let (mut spaces, mut variables) = (0, 0);
    for row in table_of(board.name, "memory-map.csv") {
        let name = row["region"].split('[').next().unwrap_or_default();
        if let Some(thread) = name.strip_prefix("user program space thread ") {
            let thread = thread.parse().ok().and_then(ThreadId::new).expect("a thread");
            assert_eq!(hexadecimal_address(board.program_base(thread)), row["start"]);
            assert_eq!(format!("0x{:X}", board.programs().size), row["size"]);
            spaces += 1;
        } else if let Some(address) = board.variable(name) {
            assert_eq!(hexadecimal_address(address), row["start"], "{name}");
            variables += 1;
        }
    }
    assert_eq!((spaces, variables), (7, 4));
}

#[test]
fn the_default_board_is_that_of_the_tables() {
    let board = TargetBoard::default_board();
    assert_eq!((board.number(), board.version_stamp()), ("4.34", 434));
    assert_eq!(super::boards().next().map(|first| first.name), Some(board.name));
    for row in FIRMWARE_FUNCTIONS.iter().filter(|row| !ABSENT.contains(&row.name)) {
        assert_eq!(board.function(row.name).map(|function| function.address), Some(row.address));
    }
    assert_eq!(board.headers(), crate::headers::EMBEDDED);
}

#[test]
fn boards_have_names_of_their_own_and_say_their_versions() {
    let names: BTreeSet<_> = boards().map(|board| board.name).collect();
    assert_eq!(names.len(), super::boards().count());
    for board in boards() {
        assert_eq!(TargetBoard::of_version(board.version).map(|found| found.name), Some(board.name));
        assert!(board.name.ends_with(board.number()), "{}", board.name);
    }
    assert_eq!(board("kflop-5.3.2").version_stamp(), 532);
    let last = ThreadId::new(7).expect("7 is a thread");
    assert_eq!(board("kogna-5.3.2").program_base(last), GuestAddr::new(0xC020_0000));
}

#[test]
fn version_texts_become_version_stamps() {
    assert_eq!(stamp("KFLOP 4.34 Build 16:07:06 Aug 14 2018"), Some(434));
    assert_eq!(stamp("KFLOP 4.35h Build 1"), Some(435));
    assert_eq!(stamp("KFLOP 5.10 Build"), Some(510));
    assert_eq!(stamp("KFLOP 5.3.2 Build 18:10:31"), Some(532));
    assert_eq!(stamp("KFLOP 900000.10"), None);
    assert_eq!(stamp("KFLOP"), None);
}

/// A firmware is added by a file of facts, which `cc67 firmware facts` prints: here for a next version, with every
/// address moved.
#[test]
fn the_facts_of_a_made_up_version_are_a_board() {
    let known = board("kflop-5.3.2");
    let version = "KFLOP 5.3.3 Build 10:00:00 Jun  1 2025";
    let mut symbols = known.symbols();
    symbols.iter_mut().for_each(|(_, address)| *address = address.offset(0x20));
    symbols.push(("ArrivedIn533", GuestAddr::new(0x8001_2340)));
    let facts = known.facts_of(version, 1_750_000_000, &symbols);
    let facts: &'static str = Box::leak((facts + "declare int ArrivedIn533(int axis)\n").into_boxed_str());
    let next = TargetBoard::read(facts);
    assert_eq!((next.name, next.version, next.time_stamp), ("kflop-5.3.3", version, Some(1_750_000_000)));
    assert_eq!((next.version_stamp(), next.axes.count(), next.is_proven), (533, 8, true));
    assert_eq!(next.structures(), known.structures());
    assert_eq!(next.programs(), known.programs());
    for (name, address) in known.symbols() {
        let moved = |address: GuestAddr| address.offset(0x20);
        assert_eq!(next.variable(name), known.variable(name).map(moved), "{name}");
        let types = |board: &TargetBoard| board.function(name).map(|function| (function.ty, function.origin));
        assert_eq!(types(&next), types(known), "{name}");
        assert!(next.symbols().contains(&(name, address.offset(0x20))), "{name}");
    }
    let arrived = next.function("ArrivedIn533").map(|function| (function.address.get(), function.origin));
    assert_eq!(arrived, Some((0x8001_2340, Origin::Header)));
    let header = |board: &TargetBoard| {
        let texts = board.headers().iter().map(|(_, text)| String::from_utf8_lossy(text).into_owned());
        texts.collect::<String>()
    };
    let expect = header(known).replace("5.3.2", "5.3.3");
    assert_eq!(header(&next).replace("int ArrivedIn533(int axis);\n", ""), expect);
    let changes = known.differences(&next);
    let change = |name: &str| changes.iter().find(|one| one.name == name).map(|one| one.change.as_str());
    assert_eq!(changes.len(), 2, "{changes:?}");
    assert_eq!(change("ArrivedIn533"), Some("only in kflop-5.3.3"));
    assert_eq!(change("KMOTION_VER"), Some("`\"5.3.2\"` in kflop-5.3.2, `\"5.3.3\"` in kflop-5.3.3"));
}

#[test]
fn differences_name_what_a_program_meets_that_moves() {
    let differences = board("kflop-4.34").differences(board("kflop-5.3.2"));
    let change = |name: &str| differences.iter().find(|one| one.name == name).map(|one| one.change.as_str());
    assert_eq!(change("free"), Some("only in kflop-4.34"));
    assert_eq!(change("JogAtAccel"), Some("only in kflop-5.3.2"));
    assert_eq!(change("N_CHANNELS"), Some("`8` in kflop-4.34, `N_CHANNELS_KFLOP` in kflop-5.3.2"));
    assert!(change("SPINDLE").is_some_and(|change| change.starts_with("112 and 120 bytes; ")));
    assert_eq!(change("ReadBit"), None);
    assert_eq!(board("kflop-5.3.2").differences(board("kflop-5.3.2")), []);
}

#[test]
fn names_of_other_boards_are_found() {
    let other = |of: &str, name: &str| board(of).other_with(name).map(|found| found.name);
    assert_eq!(other("kflop-4.34", "MoveAtVelAccel"), Some("kflop-5.3.2"));
    assert_eq!(other("kflop-4.34", "SPI_SetMode"), Some("kogna-5.3.2"));
    assert_eq!(other("kflop-5.3.2", "free"), Some("kflop-4.34"));
    assert_eq!(other("kflop-4.34", "MB_OK"), None);
    assert_eq!(other("kflop-4.34", "Move"), None);
    assert_eq!(other("kogna-5.3.2", "N_CHANNELS"), Some("kflop-4.34"));
}

#[test]
fn a_board_has_its_memories_and_the_places_of_its_axes() {
    let kogna = board("kogna-5.3.2");
    let map = kogna.map();
    assert_eq!((map.iram.base.get(), map.iram.size), (0x1180_0000, 0x4_0000));
    assert_eq!((map.sdram.base.get(), map.sdram.size), (0xC000_0000, 0x1000_0000));
    assert_eq!((map.fpga.base.get(), map.timer0().get(), map.counter), (0x6000_0000, 0x01F0_D010, 228));
    assert_eq!((map.flash, kogna.axes.count()), (None, 16));
    assert_eq!((map.programs, map.buffers.get()), (KOGNA_PROGRAMS, KOGNA_PROGRAMS.limit));
    let stacks = kogna.symbols().into_iter().find(|(name, _)| *name == "Stacks").map(|(_, at)| at.get());
    assert_eq!(stacks, Some(KOGNA_STACKS_BASE));
    let thread = ThreadId::new(7).expect("7 is a thread");
    assert_eq!(map.programs.space(thread), 0xC020_0000..0xC024_0000);

    let objects = kogna.moved_objects();
    let place = |table: GuestAddr| {
        let offset = |object: &MovedObject| table.get().wrapping_sub(object.table.get());
        let object = objects.iter().find(|object| offset(object) < object.size).expect("it is moved");
        object.place.offset(offset(object)).get()
    };
    for number in 0..16 {
        let axis = kogna.axes.get(number).expect("it is an axis");
        let number = number.cast_unsigned();
        assert_eq!(place(chan(axis).address()), 0x1183_2780 + 432 * number, "axis {number}");
        assert_eq!(place(trip_coeffs(axis).address()), 0xC005_5AD8 + 960 * number, "axis {number}");
    }
    for known in ["kflop-4.34", "kflop-5.3.2"] {
        assert_eq!((board(known).map(), board(known).axes.count()), (&MemoryMap::KFLOP, 8), "{known}");
    }
}
