//! Packets into words: fetch packets, labels, displacements.
//!
//! A function begins at a multiple of 32 bytes. No packet crosses such a boundary: the packet before gets parallel
//! `NOP`s, which cost no cycle.

use c67x::{FETCH_PACKET, Inst, Op, Operand, Side};

use super::code::Value;
use super::packets::{FETCH, IssuedInst, LONGEST, ScheduledRegion};
use super::text::Fixup;
use crate::relocation::FixupKind;
use crate::source::Span;

/// A function in words.
#[derive(Debug, Default)]
pub(super) struct LaidOutFunction {
    pub(super) words: Vec<u32>,
    /// Number of words of code; tables of addresses follow.
    pub(super) code: u32,
    pub(super) fixups: Vec<Fixup>,
    /// The first word of each run of words that belong to one statement.
    pub(super) spans: Vec<(u32, Span)>,
    /// The labels at which execution enters from outside: the function, and the return points of calls.
    pub(super) entries: Vec<u32>,
}

/// Lays out the regions in the order of the code; labels from `blocks` on belong to return points.
pub(super) fn lay_out(
    regions: &[ScheduledRegion],
    tables: &[Vec<u32>],
    blocks: u32,
    span: Span,
) -> LaidOutFunction {
    let labels = regions.iter().map(|region| region.label).max().unwrap_or(0) + 1;
    let mut targets = tables.concat();
    targets.sort_unstable();
    let mut layout = Layout {
        function: LaidOutFunction { spans: vec![(0, span)], ..LaidOutFunction::default() },
        labels: vec![0; labels as usize],
        pending: Vec::new(),
        open: Vec::new(),
        targets,
        tables: Vec::new(),
    };
    for region in regions {
        // The previous packet may still get NOPs when this region begins, so the label waits for the first packet.
        layout.region(region, blocks);
    }
    layout.tables(tables);
    layout.complete();
    layout.function
}

struct Layout {
    function: LaidOutFunction,
    /// The word of each label.
    labels: Vec<u32>,
    /// The labels of empty regions: they are where the next packet begins.
    pending: Vec<u32>,
    /// Words that need a label or a symbol.
    open: Vec<(u32, Value)>,
    /// Blocks that tables name, ascending.
    targets: Vec<u32>,
    /// The word of each table.
    tables: Vec<u32>,
}

impl Layout {
    fn current_word(&self) -> u32 {
        self.function.words.len() as u32
    }

    fn region(&mut self, region: &ScheduledRegion, blocks: u32) {
        let mut label = Some(region.label);
        let mut cycle = 0;
        let mut index = 0;
        while cycle < region.cycles {
            let count = region.insts[index..].iter().take_while(|issued| issued.cycle == cycle).count();
            let packet = &region.insts[index..index + count];
            index += count;
            if packet.is_empty() {
                let next = region.insts.get(index).map_or(region.cycles, |issued| issued.cycle);
                let gap = (next - cycle).min(LONGEST);
                self.begin_packet(1, &mut label, blocks, region.span);
                self.function.words.push(Inst::nop(gap).encode(false));
                cycle += gap;
                continue;
            }
            // A call is attributed to its own line, whatever else is in its packet: so it comes first.
            let mut packet: Vec<&IssuedInst> = packet.iter().collect();
            packet.sort_by_key(|issued| issued.inst.branch().is_none());
            let first = packet.first().map_or(region.span, |issued| issued.span);
            self.begin_packet(count as u32, &mut label, blocks, first);
            self.packet(&packet);
            cycle += 1;
        }
        if let Some(label) = label {
            // An empty region: its label refers to the next one.
            self.labels[label as usize] = self.current_word();
            self.pending.push(label);
        }
    }

    /// Makes room for a packet and gives it the waiting labels.
    fn begin_packet(&mut self, words: u32, label: &mut Option<u32>, blocks: u32, span: Span) {
        let used = self.current_word() % FETCH;
        if used + words > FETCH {
            self.pad();
        }
        let at = self.current_word();
        let mut pending = std::mem::take(&mut self.pending);
        pending.extend(label.take());
        pending.sort_unstable();
        for number in pending {
            self.labels[number as usize] = at;
            if number >= blocks || at == 0 || self.targets.binary_search(&number).is_ok() {
                self.function.entries.push(at);
            }
        }
        self.mark(at, span);
    }

    /// Sets the source position of the words from `at` on.
    fn mark(&mut self, at: u32, span: Span) {
        if self.function.spans.last().is_none_or(|(_, last)| *last != span) {
            match self.function.spans.last_mut() {
                Some((word, last)) if *word == at => *last = span,
                _ => self.function.spans.push((at, span)),
            }
        }
    }

    /// Fills the fetch packet with `NOP`s that belong to the last packet.
    fn pad(&mut self) {
        while !self.current_word().is_multiple_of(FETCH) {
            if let Some(word) = self.function.words.last_mut() {
                *word |= c67x::PARALLEL;
            }
            self.function.words.push(Inst::nop(1).encode(false));
        }
    }

    fn packet(&mut self, packet: &[&IssuedInst]) {
        let last = packet.len() - 1;
        for (index, issued) in packet.iter().enumerate() {
            if let Some(value) = issued.value.filter(|value| !matches!(value, Value::Number(_))) {
                self.open.push((self.current_word(), value));
            }
            // An access that traps is reported with its own line.
            if index > 0 && issued.inst.mem().is_some() {
                self.mark(self.current_word(), issued.span);
            }
            self.function.words.push(issued.inst.encode(index < last));
        }
    }

    /// Puts the tables of addresses after the code.
    fn tables(&mut self, tables: &[Vec<u32>]) {
        self.function.code = self.current_word();
        for table in tables {
            self.tables.push(self.current_word());
            for label in table {
                let at = self.current_word();
                let offset = self.labels[*label as usize] * 4;
                self.function.fixups.push(Fixup {
                    word: at,
                    kind: FixupKind::Own(offset.cast_signed()),
                    symbol: None,
                });
                self.function.words.push(0);
            }
        }
    }

    /// Completes the words that depend on labels; the rest is left to the linker.
    fn complete(&mut self) {
        for (word, value) in std::mem::take(&mut self.open) {
            let Ok(inst) = Inst::decode(self.function.words[word as usize]) else { continue };
            let own = match value {
                Value::Block(label) => Some(self.labels[label as usize]),
                Value::Table(table) => Some(self.tables[table as usize]),
                Value::Number(_) | Value::Symbol(..) => None,
            };
            if let (Op::BDisp, Some(target)) = (inst.op(), own) {
                self.set_displacement(word, inst, target);
                continue;
            }
            let (symbol, offset) = match value {
                Value::Symbol(symbol, offset) => (Some(symbol), offset),
                _ => (None, (own.unwrap_or(0) * 4).cast_signed()),
            };
            let kind = if inst.op() == Op::Mvk {
                FixupKind::Low(offset)
            } else if inst.op() == Op::Mvkh {
                FixupKind::High(offset)
            } else {
                FixupKind::Near
            };
            self.function.fixups.push(Fixup { word, kind, symbol });
        }
        self.function.fixups.sort_by_key(|fixup| fixup.word);
    }

    fn set_displacement(&mut self, word: u32, inst: Inst, target: u32) {
        let bytes = (target * 4).wrapping_sub(word / FETCH * FETCH_PACKET).cast_signed();
        let side = inst.unit().map_or(Side::B, |unit| unit.side);
        let parallel = self.function.words[word as usize] & c67x::PARALLEL != 0;
        if let Ok(inst) = Inst::new(Op::BDisp, side, inst.pred(), &[Operand::Target(bytes)]) {
            self.function.words[word as usize] = inst.encode(parallel);
        }
    }
}
