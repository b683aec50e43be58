//! Moves that happen at the same time, put in an order: arguments of calls, parameters.

use c67x::Reg;

use super::abi;

/// Orders moves from the second register of each to the first. A cycle is broken through a register that no move
/// mentions and that `free` has.
pub(super) fn in_order(moves: &[(Reg, Reg)], free: u64) -> Vec<(Reg, Reg)> {
    let mut open: Vec<(Reg, Reg)> = moves.iter().copied().filter(|(to, from)| to != from).collect();
    let mut out = Vec::with_capacity(open.len() + 1);
    let mentioned = moves.iter().fold(0, |set, (to, from)| set | abi::bit(*to) | abi::bit(*from));
    while !open.is_empty() {
        let ready = open.iter().position(|(to, _)| open.iter().all(|(_, from)| from != to));
        if let Some(index) = ready {
            out.push(open.remove(index));
            continue;
        }
        // Every destination is still a source, so this is a cycle: the value of the first one is saved.
        let (to, _) = open[0];
        let used = out.iter().fold(mentioned, |set, (to, _)| set | abi::bit(*to));
        let Some(aside) = abi::registers(free & !used).next() else { break };
        out.push((aside, to));
        for (_, from) in &mut open {
            if *from == to {
                *from = aside;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(moves: &[(Reg, Reg)]) {
        let ordered = in_order(moves, abi::CHANGED);
        let mut file: Vec<usize> = (0..Reg::COUNT).collect();
        for (to, from) in ordered {
            file[to.index()] = file[from.index()];
        }
        for (to, from) in moves {
            assert_eq!(file[to.index()], from.index(), "{moves:?}");
        }
    }

    #[test]
    fn cyclic_and_chained_moves_give_the_right_values() {
        let [a, b, c, d] = [Reg::a(4), Reg::b(4), Reg::a(6), Reg::b(6)];
        run(&[]);
        run(&[(a, b), (b, a)]);
        run(&[(a, b), (b, c), (c, a), (d, a)]);
        run(&[(a, b), (b, c), (c, d)]);
        run(&[(a, b), (b, a), (c, d), (d, c)]);
    }
}
