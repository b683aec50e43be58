//! Imports within a crate point downwards in `layers.txt`, and there are no cycles.

use std::collections::{BTreeMap, BTreeSet};

use crate::imports::{self, Imports};

/// The maximum number of files that may import each other: two that describe one subject, and one that joins them.
const MAX_FILES_IN_A_CYCLE: usize = 3;

/// The layers of a crate, from top to bottom: the name of each, and its modules.
struct Layers {
    krate: &'static str,
    rows: Vec<(&'static str, Vec<&'static str>)>,
}

fn layers() -> Vec<Layers> {
    let mut all: Vec<Layers> = Vec::new();
    for line in include_str!("layers.txt").lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(krate) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            all.push(Layers { krate, rows: Vec::new() });
        } else {
            let (name, rooms) = line.split_once(": ").unwrap_or_else(|| panic!("layers.txt: {line}"));
            let rows = &mut all.last_mut().expect("the first line names a crate").rows;
            rows.push((name, rooms.split(' ').collect()));
        }
    }
    all
}

/// The row of a file; the longest matching path counts.
fn row_of(layers: &Layers, file: &str) -> Option<usize> {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let fits =
        |room: &str| stem.strip_prefix(room).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
    let rooms = layers
        .rows
        .iter()
        .enumerate()
        .flat_map(|(row, (_, rooms))| rooms.iter().map(move |room| (row, room)));
    rooms.filter(|(_, room)| fits(room)).max_by_key(|(_, room)| room.len()).map(|(row, _)| row)
}

#[test]
fn imports_inside_a_crate_point_downwards() {
    let mut wrong = Vec::new();
    for layers in layers() {
        let (krate, imports) = (layers.krate, imports::read(layers.krate));
        for file in imports.files.iter().filter(|file| *file != "lib.rs" && row_of(&layers, file).is_none()) {
            wrong.push(format!("{krate}/src/{file} is in no row of tests/tidy/layers.txt"));
        }
        for (from, targets) in &imports.arrows {
            for (to, line) in targets {
                let (Some(row), Some(above)) = (row_of(&layers, from), row_of(&layers, to)) else { continue };
                if above < row {
                    let (name, upper) = (layers.rows[row].0, layers.rows[above].0);
                    wrong.push(format!(
                        "{krate}/src/{from}:{line} in row `{name}` imports {to} of row `{upper}` above"
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

type Graph = BTreeMap<String, BTreeSet<String>>;

/// The graph of the modules directly in `src`.
fn rooms(imports: &Imports) -> Graph {
    let room = |file: &str| file.split('/').next().unwrap_or(file).trim_end_matches(".rs").to_owned();
    let mut graph = Graph::new();
    for (from, to) in
        imports.arrows.iter().flat_map(|(from, targets)| targets.keys().map(move |to| (from, to)))
    {
        if room(from) != room(to) && ![room(from), room(to)].contains(&"lib".to_owned()) {
            graph.entry(room(from)).or_default().insert(room(to));
        }
    }
    graph
}

/// The nodes reachable from a node.
fn reached<'a>(graph: &'a Graph, from: &'a str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut pending = vec![from];
    while let Some(node) = pending.pop() {
        let next = graph.get(node).into_iter().flatten();
        pending.extend(next.filter(|next| found.insert(next.as_str())).map(String::as_str));
    }
    found
}

/// The groups of more than one node that reach each other.
fn cycles(graph: &Graph) -> BTreeSet<Vec<&str>> {
    let reach: BTreeMap<&str, BTreeSet<&str>> =
        graph.keys().map(|node| (node.as_str(), reached(graph, node))).collect();
    let returns = |node: &str, other: &str| reach.get(other).is_some_and(|back| back.contains(node));
    let groups = reach.iter().map(|(node, theirs)| {
        theirs.iter().copied().filter(|other| returns(node, other)).collect::<Vec<_>>()
    });
    groups.filter(|group| group.len() > 1).collect()
}

#[test]
fn no_rooms_of_a_crate_form_an_import_cycle() {
    for Layers { krate, .. } in layers() {
        let graph = rooms(&imports::read(krate));
        assert_eq!(cycles(&graph), BTreeSet::new(), "{krate}: rooms that import each other");
    }
}

#[test]
fn no_import_cycle_has_more_than_three_files() {
    for Layers { krate, .. } in layers() {
        let arrows = imports::read(krate).arrows.into_iter();
        let graph: Graph = arrows.map(|(from, targets)| (from, targets.into_keys().collect())).collect();
        for group in cycles(&graph) {
            assert!(group.len() <= MAX_FILES_IN_A_CYCLE, "{krate}: files that import each other: {group:?}");
        }
    }
}

#[test]
fn cycles_are_found() {
    let arrows = [("a", vec!["b"]), ("b", vec!["c", "d"]), ("c", vec!["a"]), ("d", vec!["e"])];
    let graph: Graph = (arrows.into_iter())
        .map(|(from, to)| (from.to_owned(), to.into_iter().map(str::to_owned).collect()))
        .collect();
    assert_eq!(cycles(&graph), BTreeSet::from([vec!["a", "b", "c"]]));
}
