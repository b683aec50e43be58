//! Comparison of two images: headers, sections, symbols.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use coff::{Image, Section};

use super::{Entry, Inspection};

/// Most differing symbols that are listed.
const LISTED: usize = 40;

/// The differences, one per line; none for images with the same memory contents and the same names.
#[must_use]
pub fn compare(a: &Inspection, b: &Inspection) -> Vec<String> {
    let mut lines = headers(&a.image, &b.image);
    lines.extend(sections(&a.image, &b.image));
    lines.extend(symbols(&a.symbols, &b.symbols));
    if a.lines != b.lines {
        lines.push(format!("line numbers: {} and {}, or at other places", a.lines.len(), b.lines.len()));
    }
    lines
}

fn headers(a: &Image, b: &Image) -> Vec<String> {
    let mut lines = Vec::new();
    let mut check = |what: &str, a: String, b: String| {
        if a != b {
            lines.push(format!("{what}: {a} and {b}"));
        }
    };
    check("target", a.target.to_string(), b.target.to_string());
    check("flags", a.flags.to_string(), b.flags.to_string());
    check("timestamp", a.timestamp.to_string(), b.timestamp.to_string());
    let (p, q) = (a.program.unwrap_or_default(), b.program.unwrap_or_default());
    check("entry", format!("{:08x}", p.entry), format!("{:08x}", q.entry));
    check("version stamp", p.version_stamp.to_string(), q.version_stamp.to_string());
    check("uninitialised data", p.bss_size.to_string(), q.bss_size.to_string());
    lines
}

fn sections(a: &Image, b: &Image) -> Vec<String> {
    let mut lines = Vec::new();
    for first in &a.sections {
        match b.sections.iter().find(|second| second.name == first.name) {
            Some(second) => lines.extend(section(first, second)),
            None => lines.push(format!("section {}: only in the first", first.name)),
        }
    }
    let added = b.sections.iter().filter(|second| a.sections.iter().all(|first| first.name != second.name));
    lines.extend(added.map(|section| format!("section {}: only in the second", section.name)));
    lines
}

fn section(a: &Section, b: &Section) -> Option<String> {
    let mut line = String::new();
    // Writing to a string cannot fail.
    if a.address != b.address {
        let _ = write!(line, " at {:08x} and {:08x}", a.address, b.address);
    }
    if a.size() != b.size() {
        let _ = write!(line, " {} and {} bytes", a.size(), b.size());
    }
    if a.flags != b.flags {
        let _ = write!(line, " {} and {}", a.flags, b.flags);
    }
    let mut pairs = a.data().iter().zip(b.data()).enumerate().filter(|(_, (a, b))| a != b);
    if let Some((first, _)) = pairs.next() {
        let _ = write!(line, " {} bytes differ, the first at offset {first:#x}", 1 + pairs.count());
    }
    (!line.is_empty()).then(|| format!("section {}:{line}", a.name))
}

fn symbols(a: &[Entry], b: &[Entry]) -> Vec<String> {
    let by_name = |entries: &[Entry]| -> BTreeMap<(String, Option<String>), Entry> {
        entries.iter().map(|entry| ((entry.name.clone(), entry.file.clone()), entry.clone())).collect()
    };
    let (a, b) = (by_name(a), by_name(b));
    let mut lines = Vec::new();
    for (name, first) in &a {
        match b.get(name) {
            None => lines.push(format!("`{}`: only in the first", first.name)),
            Some(second) if second.address != first.address || second.size != first.size => {
                lines.push(format!("`{}`: {} and {}", first.name, place(first), place(second)));
            }
            Some(_) => {}
        }
    }
    let added = b.iter().filter(|(name, _)| !a.contains_key(*name));
    lines.extend(added.map(|(_, entry)| format!("`{}`: only in the second", entry.name)));
    if lines.len() > LISTED {
        let more = lines.len() - LISTED;
        lines.truncate(LISTED);
        lines.push(format!("{more} more symbols differ"));
    }
    lines
}

fn place(entry: &Entry) -> String {
    let size = entry.size.map_or_else(String::new, |size| format!(", {size} bytes"));
    format!("{:08x}{size}", entry.address)
}
