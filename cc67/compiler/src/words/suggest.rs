//! Suggestions: finds the known name that was probably meant.

/// The candidate most similar to `name`, if any is close enough.
///
/// The distance is the number of letters that are changed, added, left out or swapped with their neighbour (optimal
/// string alignment); another letter case counts as a quarter. A third of the letters may differ. Otherwise the longest
/// candidate that abbreviates the name is taken; an abbreviation of six or more letters takes precedence over a
/// candidate that is only similar: `MoveRel` for `MoveRelative`.
pub fn suggest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let limit = (name.chars().count() * CHANGE / 3).max(CHANGE);
    let mut best: Option<(usize, &str)> = None;
    let mut abbreviation: Option<&str> = None;
    for candidate in candidates {
        if abbreviates(candidate, name) && abbreviation.is_none_or(|known| known.len() < candidate.len()) {
            abbreviation = Some(candidate);
        }
        let bound = best.map_or(limit, |(distance, _)| distance);
        if candidate.len().abs_diff(name.len()) * CHANGE > bound || candidate == name {
            continue;
        }
        let distance = distance(name, candidate);
        if distance <= limit && best.is_none_or(|(least, known)| (distance, candidate) < (least, known)) {
            best = Some((distance, candidate));
        }
    }
    let near = best.map(|(distance, candidate)| (distance > CHANGE * 2, candidate));
    match (near, abbreviation) {
        (Some((true, _)), Some(long)) if long.len() >= LONG => Some(long),
        (Some((_, candidate)), _) => Some(candidate),
        (None, abbreviation) => abbreviation,
    }
}

/// Reports whether `short` is the beginning of `name`, in any letter case: `Vel` of `velocity`.
fn abbreviates(short: &str, name: &str) -> bool {
    const LEAST: usize = 3;
    let beginning = name.get(..short.len());
    short.len() >= LEAST
        && short.len() < name.len()
        && beginning.is_some_and(|b| b.eq_ignore_ascii_case(short))
}

/// Letters of an abbreviation that is hardly there by chance.
const LONG: usize = 6;

/// Weight of a changed letter; a changed letter case weighs 1.
const CHANGE: usize = 4;

fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    // The rows for the first i-1, i and i+1 letters of `a`.
    let mut before: Vec<usize> = Vec::new();
    let mut row: Vec<usize> = (0..=b.len()).map(|j| j * CHANGE).collect();
    for (i, x) in a.iter().enumerate() {
        let mut next = vec![(i + 1) * CHANGE];
        for (j, y) in b.iter().enumerate() {
            let mut least = (row[j] + weight(*x, *y)).min(row[j + 1] + CHANGE).min(next[j] + CHANGE);
            if i > 0 && j > 0 && a[i - 1] == *y && b[j - 1] == *x {
                least = least.min(before[j - 1] + CHANGE);
            }
            next.push(least);
        }
        before = std::mem::replace(&mut row, next);
    }
    row[b.len()]
}

fn weight(x: char, y: char) -> usize {
    match (x == y, x.eq_ignore_ascii_case(&y)) {
        (true, _) => 0,
        (false, true) => 1,
        (false, false) => CHANGE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_wins() {
        let check = |name, candidates: &[&'static str], expect| {
            assert_eq!(suggest(name, candidates.iter().copied()), expect, "{name}");
        };
        check("Readbit", &["SetBit", "ReadBit", "ReadADC"], Some("ReadBit"));
        check("t0", &["T0", "t1"], Some("T0"));
        check("WaitNextTimeSlcie", &["WaitNextTimeSlice", "WaitUntil"], Some("WaitNextTimeSlice"));
        check("inlcude", &["include", "undef"], Some("include"));
        check("xxx", &["persist", "abc"], None);
        check("printf", &["printf"], None);
        check("Velocity", &["Accel", "Vel", "Vex"], Some("Vel"));
        check("velocity", &["Ve", "loc"], None);
        check("MoveRelative", &["Move", "MoveRelAtVel", "MoveRel"], Some("MoveRel"));
        check("MoveRelAtVell", &["MoveRel", "MoveRelAtVel"], Some("MoveRelAtVel"));
    }
}
