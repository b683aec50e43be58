//! The contents of all listings as JSON, for tools.

use coff::Contents;
use serde_json::{Value, json};

use super::{Inspection, Order};

impl Inspection {
    /// The whole inspection.
    #[must_use]
    pub fn to_json(&self, order: Order) -> Value {
        let image = &self.image;
        let program = image.program.as_ref().map(|program| {
            json!({
                "entry": program.entry,
                "version_stamp": program.version_stamp,
                "text_size": program.text_size,
                "data_size": program.data_size,
                "bss_size": program.bss_size,
            })
        });
        json!({
            "target": image.target.to_string(),
            "flags": image.flags.to_string(),
            "timestamp": image.timestamp,
            "program": program,
            "sections": self.sections_json(),
            "symbols": self.symbols_json(order),
            "lines": self.lines_json(),
            "functions": self.functions_json(),
        })
    }

    fn sections_json(&self) -> Vec<Value> {
        let section = |section: &coff::Section| {
            json!({
                "name": section.name.to_string(),
                "address": section.address,
                "size": section.size(),
                "flags": section.flags.0,
                "initialised": matches!(section.contents, Contents::Data(_)),
                "relocations": section.relocations.len(),
                "lines": section.lines.len(),
            })
        };
        self.image.sections.iter().map(section).collect()
    }

    fn symbols_json(&self, order: Order) -> Vec<Value> {
        let symbols = self.sorted(order).into_iter();
        let symbol = symbols.map(|entry| {
            json!({
                "name": entry.name,
                "address": entry.address,
                "size": entry.size,
                "section": entry.section,
                "kind": entry.kind.name(),
                "external": entry.is_external,
                "file": entry.file,
            })
        });
        symbol.collect()
    }

    fn lines_json(&self) -> Vec<Value> {
        let line = |line: &super::SourceLine| {
            json!({
                "address": line.address,
                "file": line.file,
                "line": line.line,
                "function": line.function,
            })
        };
        self.lines.iter().map(line).collect()
    }

    /// Functions with their calls; empty for code that cannot be run here.
    fn functions_json(&self) -> Vec<Value> {
        let Ok(calls) = self.call_graph() else { return Vec::new() };
        let names = |numbers: &std::collections::BTreeSet<usize>| -> Vec<&str> {
            numbers.iter().filter_map(|index| Some(calls.nodes.get(*index)?.name.as_str())).collect()
        };
        let functions = calls.nodes.iter().map(|node| {
            json!({
                "name": node.name,
                "address": node.address,
                "frame": node.frame,
                "calls": names(&node.calls),
                "through_pointers": names(&node.through_pointers),
                "firmware": node.firmware,
            })
        });
        functions.collect()
    }
}
