//! The cost of the processor's code: cycles of functions and of loop iterations, and the listing that explains them.
//!
//! The cycles are those of the packets (`c67x.md` section 5), without waits for memory. If the code can take several
//! paths, the shortest and the longest are given; an inner loop counts as one iteration, a call only as its branch.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::disassembly::Sources;
use super::machine::{self, Block, CallTarget, Routine};
use super::{Inspection, calls::firmware_name};

/// A loop: a jump back to a block before it.
#[derive(Debug)]
struct Loop {
    first: usize,
    last: usize,
    /// The shortest and the longest iteration.
    iteration: (u32, u32),
}

impl Inspection {
    /// Cycles of every function and loop, as a table.
    #[must_use]
    pub fn cycles(&self) -> String {
        let functions = match machine::functions(self) {
            Ok(functions) => functions,
            Err(reason) => return format!("no cycles: {reason}\n"),
        };
        let (clock, slice) = (self.board().clock, self.board().cycles_of_tick());
        let mut out = format!("cycles at {clock} MHz; share of the {slice} between two interrupts (90 µs)\n");
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{:>13} {:>8}", "cycles", "share");
        for code in &functions {
            let own = code.path(0, None).unwrap_or_default();
            let _ = writeln!(out, "{}  {}, {} bytes", span(own, slice), code.name, code.bytes);
            for found in code.loops() {
                let lines = self.lines_of(code, &found);
                let _ = write!(out, "{}    an iteration of the loop{lines}", span(found.iteration, slice));
                let calls = self.called_names(&code.blocks[found.first..=found.last]);
                let _ = match calls.as_str() {
                    "" => writeln!(out),
                    calls => writeln!(out, ", without {calls}"),
                };
            }
        }
        out
    }

    /// The packets of every function, or of one, with units, cycles and the lines of the source.
    #[must_use]
    pub fn assembly(&self, sources: &dyn Sources, only: Option<&str>) -> String {
        let functions = match machine::functions(self) {
            Ok(functions) => functions,
            Err(reason) => return format!("no assembly: {reason}\n"),
        };
        let mut listing = Listing { inspection: self, sources, files: BTreeMap::new(), out: String::new() };
        for code in functions.iter().filter(|code| only.is_none_or(|only| only == code.name)) {
            listing.function(code);
        }
        listing.out
    }

    /// " at line 12" or " at lines 12 to 15".
    fn lines_of(&self, code: &Routine, found: &Loop) -> String {
        let packets = code.blocks[found.first].packets.start..code.blocks[found.last].packets.end;
        let lines =
            || code.packets[packets.clone()].iter().filter_map(|packet| Some(self.line_at(packet.at)?.line));
        match (lines().min(), lines().max()) {
            (Some(first), Some(last)) if first == last => format!(" at line {first}"),
            (Some(first), Some(last)) => format!(" at lines {first} to {last}"),
            _ => String::new(),
        }
    }

    /// The names of the functions called by blocks.
    fn called_names(&self, blocks: &[Block]) -> String {
        let mut names: Vec<String> =
            blocks.iter().filter_map(|block| Some(self.callee(block.call?))).collect();
        names.sort();
        names.dedup();
        names.join(", ")
    }

    fn callee(&self, call: CallTarget) -> String {
        match call {
            CallTarget::At(address) => firmware_name(self, machine::resolve_trampoline(&self.image, address)),
            CallTarget::Pointer => "what a pointer calls".to_owned(),
        }
    }
}

/// "7 cycles, 0.04%" or "7–20 cycles, 0.11%".
fn cycles(own: (u32, u32), slice: u32) -> String {
    let text = span(own, slice);
    let (cycles, share) = text.trim_start().split_once(' ').unwrap_or_default();
    format!("{cycles} cycles, {}", share.trim_start())
}

/// "7" or "7–20" cycles, and the share of a slice.
fn span((least, most): (u32, u32), slice: u32) -> String {
    let cycles = if least == most { most.to_string() } else { format!("{least}–{most}") };
    format!("{cycles:>13} {:7.2}%", f64::from(most) * 100.0 / f64::from(slice))
}

impl Routine {
    /// The shortest and the longest forward path from a block to the end of the function, or to the backward jump to
    /// it.
    fn path(&self, from: usize, within: Option<usize>) -> Option<(u32, u32)> {
        let last = within.unwrap_or(self.blocks.len() - 1);
        let mut paths: Vec<Option<(u32, u32)>> = vec![None; self.blocks.len()];
        for index in (from..=last).rev() {
            let block = &self.blocks[index];
            let mut best: Option<(u32, u32)> = None;
            let mut join = |(least, most): (u32, u32)| {
                best = Some(best.map_or((least, most), |(a, b)| (a.min(least), b.max(most))));
            };
            for edge in &block.edges {
                if within.is_some() && edge.to == from {
                    join((edge.cycles, edge.cycles));
                } else if edge.to > index
                    && let Some((least, most)) = paths[edge.to]
                {
                    join((edge.cycles + least, edge.cycles + most));
                }
            }
            let leaves = block.edges.iter().all(|edge| edge.to <= index);
            if within.is_none() && leaves {
                join((block.cycles, block.cycles));
            }
            paths[index] = best;
        }
        paths.get(from).copied().flatten()
    }

    /// The loops, in the order of the code.
    fn loops(&self) -> Vec<Loop> {
        let mut ends: BTreeMap<usize, usize> = BTreeMap::new();
        for (index, block) in self.blocks.iter().enumerate() {
            for edge in block.edges.iter().filter(|edge| edge.to <= index) {
                ends.insert(edge.to, index);
            }
        }
        let loops = ends.into_iter().filter_map(|(first, last)| {
            let iteration = self.path(first, Some(last))?;
            Some(Loop { first, last, iteration })
        });
        loops.collect()
    }

    /// Explains whether the stages of several iterations overlap in a loop.
    fn remark(&self, found: &Loop) -> &'static str {
        let blocks = &self.blocks[found.first..=found.last];
        if blocks.iter().any(|block| block.call.is_some()) {
            "not pipelined: it calls"
        } else if blocks.len() > 1 {
            "not pipelined: it has branches inside"
        } else if self.overlaps(&blocks[0]) {
            "pipelined: its iterations overlap"
        } else if self.is_filled(&blocks[0]) {
            "every cycle issues"
        } else {
            "its iterations wait for results, or for the branch"
        }
    }

    /// Reports whether results are in flight from one iteration to the next.
    fn overlaps(&self, block: &Block) -> bool {
        let packets = &self.packets[block.packets.clone()];
        let cycles: u32 = packets.iter().map(|packet| packet.cycles).sum();
        let mut at = 0;
        packets.iter().any(|packet| {
            let is_late = |inst: &c67x::Inst| inst.writes().any(|write| at + u32::from(write.stage) > cycles);
            let found = packet.insts.iter().any(is_late);
            at += packet.cycles;
            found
        })
    }

    fn is_filled(&self, block: &Block) -> bool {
        let nothing = |inst: &c67x::Inst| inst.unit().is_none();
        !self.packets[block.packets.clone()].iter().any(|packet| packet.insts.iter().all(nothing))
    }
}

struct Listing<'a> {
    inspection: &'a Inspection,
    sources: &'a dyn Sources,
    /// The lines of each file used so far; `None` if the file is not found.
    files: BTreeMap<String, Vec<String>>,
    out: String,
}

impl Listing<'_> {
    fn function(&mut self, code: &Routine) {
        let own = code.path(0, None).unwrap_or_default();
        // Writing to a string cannot fail.
        let _ = writeln!(
            self.out,
            "{}: ; {:08x}, {} bytes, {} of stack, {} of the cycles between two interrupts",
            code.name,
            code.address,
            code.bytes,
            super::frames::max_frame_depth(code)
                .map_or_else(|| "unknown".to_owned(), |bytes| bytes.to_string()),
            cycles(own, self.inspection.board().cycles_of_tick()),
        );
        let mut last = None;
        let loops = code.loops();
        for (number, block) in code.blocks.iter().enumerate() {
            for found in loops.iter().filter(|found| found.first == number) {
                let (least, most) = found.iteration;
                let shown = if least == most { most.to_string() } else { format!("{least} to {most}") };
                let _ = writeln!(self.out, "; loop, {shown} cycles an iteration; {}", code.remark(found));
            }
            let start = code.packets[block.packets.start].time;
            for packet in &code.packets[block.packets.clone()] {
                let line = self.inspection.line_at(packet.at).map(|line| (line.file.clone(), line.line));
                if line != last {
                    self.source(line.as_ref());
                    last = line;
                }
                self.packet(packet, packet.time - start);
            }
            if let Some(call) = block.call {
                let name = self.inspection.callee(call);
                let _ = writeln!(self.out, "; calls {name}");
            }
        }
        self.out.push('\n');
    }

    fn packet(&mut self, packet: &machine::Packet, cycle: u32) {
        for (index, (at, inst)) in (packet.at..).step_by(4).zip(&packet.insts).enumerate() {
            let (cycle, bars) = if index == 0 { (cycle.to_string(), "  ") } else { (String::new(), "||") };
            let _ = writeln!(self.out, "{at:08x} {cycle:>4} {bars} {}", inst.text(at));
        }
    }

    /// A line of the source, or only its position if the file is not found.
    fn source(&mut self, line: Option<&(Option<String>, u32)>) {
        let Some((file, line)) = line else { return };
        let file = file.as_deref().unwrap_or("?");
        if !self.files.contains_key(file) {
            let text = self.sources.text(file).unwrap_or_default();
            self.files.insert(file.to_owned(), text.lines().map(str::to_owned).collect());
        }
        let lines = self.files.get(file).map_or(&[][..], Vec::as_slice);
        let text = (*line as usize).checked_sub(1).and_then(|index| lines.get(index));
        let _ = writeln!(self.out, "; {file}:{line}: {}", text.map_or("", |text| text.trim()));
    }
}
