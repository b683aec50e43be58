//! Groups of nodes that reach each other, and the longest way round.

use std::collections::{BTreeMap, BTreeSet};

/// Who leads to whom.
pub(crate) type Graph = BTreeMap<String, BTreeSet<String>>;

/// The groups of more than one node that reach each other, largest first.
pub(crate) fn groups(graph: &Graph) -> Vec<BTreeSet<String>> {
    let reach: BTreeMap<&String, BTreeSet<String>> =
        graph.keys().map(|node| (node, reached(graph, node))).collect();
    let mut found: Vec<BTreeSet<String>> = Vec::new();
    for (node, theirs) in &reach {
        if found.iter().any(|group| group.contains(*node)) {
            continue;
        }
        let mut group: BTreeSet<String> = (theirs.iter())
            .filter(|other| reach.get(other).is_some_and(|back| back.contains(*node)))
            .cloned()
            .collect();
        group.insert((*node).clone());
        if group.len() > 1 {
            found.push(group);
        }
    }
    found.sort_by_key(|group| std::cmp::Reverse(group.len()));
    found
}

fn reached(graph: &Graph, from: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut pending = vec![from];
    while let Some(node) = pending.pop() {
        for next in graph.get(node).into_iter().flatten() {
            if found.insert(next.clone()) {
                pending.push(next);
            }
        }
    }
    found
}

/// Steps after which the search for a longer way ends: all ways of a large group are too many to try.
const STEPS: usize = 200_000;

/// The longest way through a group that returns to its start without meeting a node twice, as far as it was looked for.
pub(crate) fn longest(graph: &Graph, group: &BTreeSet<String>) -> Vec<String> {
    let mut best = Vec::new();
    let mut steps = STEPS;
    for start in group {
        walk(graph, group, &mut vec![start], &mut best, &mut steps);
    }
    best
}

fn walk<'a>(
    graph: &'a Graph,
    group: &BTreeSet<String>,
    way: &mut Vec<&'a str>,
    best: &mut Vec<String>,
    steps: &mut usize,
) {
    let Some(last) = way.last().copied() else { return };
    for next in graph.get(last).into_iter().flatten().filter(|next| group.contains(*next)) {
        if *steps == 0 {
            return;
        }
        *steps -= 1;
        if way.first() == Some(&next.as_str()) {
            if way.len() > best.len() {
                *best = way.iter().map(ToString::to_string).collect();
            }
        } else if !way.contains(&next.as_str()) {
            way.push(next);
            walk(graph, group, way, best, steps);
            way.pop();
        }
    }
}

#[test]
fn cycles_are_found() {
    let graph: Graph =
        [("a", vec!["b"]), ("b", vec!["c", "d"]), ("c", vec!["a"]), ("d", vec!["e"]), ("e", vec![])]
            .into_iter()
            .map(|(from, to)| (from.to_owned(), to.into_iter().map(str::to_owned).collect()))
            .collect();
    let found = groups(&graph);
    assert_eq!(found.len(), 1);
    assert_eq!(longest(&graph, &found[0]), ["a", "b", "c"]);
}
