//! Arrows inside a crate point downwards, and nothing goes round.

use std::collections::{BTreeMap, BTreeSet};

use crate::circles::{self, Graph};
use crate::imports::{self, Imports};
use crate::layers::{CIRCLES, FILES_IN_A_CIRCLE, LAYERS, Row, UPWARDS};

/// Files that may reach each other: two that describe one thing, and one that joins them.
const ALLOWED: usize = 3;

/// The row and the room of a file; the longest path of a room that fits.
fn room_of<'a>(rows: &'a [Row], file: &str) -> Option<(usize, &'a str)> {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let fits =
        |room: &str| stem.strip_prefix(room).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
    let rooms =
        rows.iter().enumerate().flat_map(|(row, (_, rooms))| rooms.iter().map(move |room| (row, *room)));
    rooms.filter(|(_, room)| fits(room)).max_by_key(|(_, room)| room.len())
}

/// What is wrong with the arrows of a crate; the exceptions that were met are added to `met`.
fn upward(krate: &str, rows: &[Row], imports: &Imports, met: &mut BTreeSet<(String, String)>) -> Vec<String> {
    let mut wrong = Vec::new();
    for file in imports.files.iter().filter(|file| *file != "lib.rs") {
        if room_of(rows, file).is_none() {
            wrong.push(format!("{krate}/src/{file} is in no row of tests/tidy/layers.rs"));
        }
    }
    for (from, targets) in &imports.arrows {
        for (to, lines) in targets {
            let (Some((row, room)), Some((above, other))) = (room_of(rows, from), room_of(rows, to)) else {
                continue;
            };
            if above >= row {
                continue;
            }
            if UPWARDS.contains(&(krate, room, other)) {
                met.insert((room.to_owned(), other.to_owned()));
                continue;
            }
            let (name, upper) = (rows[row].0, rows[above].0);
            wrong.push(format!(
                "{krate}/src/{from}:{} in row `{name}` imports {to} of row `{upper}` above: (\"{krate}\", \"{room}\", \"{other}\")",
                lines[0]
            ));
        }
    }
    wrong
}

#[test]
fn imports_inside_a_crate_point_downwards() {
    let mut wrong = Vec::new();
    for (krate, rows) in LAYERS {
        let mut met = BTreeSet::new();
        wrong.extend(upward(krate, rows, &imports::read(krate), &mut met));
        for (_, from, to) in UPWARDS.iter().filter(|(name, ..)| name == krate) {
            if !met.contains(&((*from).to_owned(), (*to).to_owned())) {
                println!("{krate}: {from} imports {to} no more: take it out of UPWARDS");
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The graph of rooms: what is directly in `src`.
fn rooms(imports: &Imports) -> Graph {
    let room = |file: &str| file.split('/').next().unwrap_or(file).trim_end_matches(".rs").to_owned();
    let mut graph = Graph::new();
    for (from, targets) in &imports.arrows {
        for to in targets.keys() {
            if room(from) != room(to) && ![room(from), room(to)].contains(&"lib".to_owned()) {
                graph.entry(room(from)).or_default().insert(room(to));
            }
        }
    }
    graph
}

fn file_graph(imports: &Imports) -> Graph {
    imports.arrows.iter().map(|(from, targets)| (from.clone(), targets.keys().cloned().collect())).collect()
}

#[test]
fn no_rooms_of_a_crate_form_an_import_cycle() {
    let mut wrong = Vec::new();
    for (krate, _) in LAYERS {
        let graph = rooms(&imports::read(krate));
        for group in circles::groups(&graph) {
            let names: Vec<&str> = group.iter().map(String::as_str).collect();
            let is_known = CIRCLES
                .iter()
                .any(|(name, known)| name == krate && names.iter().all(|room| known.contains(room)));
            println!("{krate}: {} rooms in a circle: {}", names.len(), names.join(", "));
            if !is_known {
                wrong.push(format!("{krate}: the rooms {} import each other", names.join(", ")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_import_cycle_has_more_than_three_files() {
    let known: BTreeMap<&str, usize> = FILES_IN_A_CIRCLE.iter().copied().collect();
    let mut longest: (usize, String) = (0, String::new());
    let mut wrong = Vec::new();
    for (krate, _) in LAYERS {
        let graph = file_graph(&imports::read(krate));
        for group in circles::groups(&graph) {
            let way = circles::longest(&graph, &group);
            let shown = format!(
                "{krate}: {} files reach each other; a way of {}: {}",
                group.len(),
                way.len(),
                way.join(" → ")
            );
            if group.len() > known.get(krate).copied().unwrap_or(ALLOWED).max(ALLOWED) {
                wrong.push(shown.clone());
            }
            if way.len() > longest.0 {
                longest = (way.len(), shown);
            }
        }
    }
    println!("the longest: {}", longest.1);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
