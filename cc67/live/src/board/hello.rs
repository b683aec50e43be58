//! The data that a page needs before the first frame: axes, bits, programs and their sources.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use kmotiondef::bits::BitDirection;
use kmotiondef::{Axes, AxisId, Bit};
use runtime::machine_file::{Condition, Model};
use serde_json::{Value, json};

use crate::Show;
use crate::names::{self, UsedBit};

/// The board's LEDs.
const LAMPS: [i32; 2] = [46, 47];

/// The files of all programs.
pub(super) fn files(show: &Show) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = Vec::new();
    for program in show.programs.iter().filter(|program| !program.is_image) {
        for file in names::files_of(&program.path, &show.include_dirs) {
            if !files.contains(&file) {
                files.push(file);
            }
        }
    }
    files
}

/// The sources as a message.
pub(super) fn sources(show: &Show) -> Value {
    let source = |path: PathBuf| {
        let bytes = fs::read(&path).ok()?;
        Some(json!({ "file": path.display().to_string(), "text": names::decode_text(&bytes) }))
    };
    let sources: Vec<_> = files(show).into_iter().filter_map(source).collect();
    json!({ "kind": "sources", "sources": sources })
}

/// Returns the data that does not change while the board runs, and the programs' names of their bits.
pub(super) fn hello(show: &Show, axes: Axes) -> Value {
    let axes = axes.iter().zip(&show.machine.file.axes).map(|(axis, described)| {
        let name = if described.name.is_empty() { format!("Axis {axis}") } else { described.name.clone() };
        json!({
            "axis": axis.get(), "name": name, "units": described.units, "exists": described.model != Model::None,
            "min": described.travel.min, "max": described.travel.max,
        })
    });
    let axes = axes.collect::<Vec<_>>();
    let programs = show
        .programs
        .iter()
        .map(|program| json!({ "thread": program.thread.get(), "file": program.path.display().to_string() }));
    let programs = programs.collect::<Vec<_>>();
    json!({
        "kind": "hello", "title": show.title, "version": env!("CARGO_PKG_VERSION"),
        "tick": kmotiondef::limits::TIMEBASE, "axes": axes, "programs": programs,
        "bits": bits(show), "switches": switches(show), "time": show.time.word(),
    })
}

/// The switches that axes trip, with their positions.
fn switches(show: &Show) -> Vec<Value> {
    let switch = |bit: Bit, axis: AxisId, when: Condition| {
        let (from, to) = match when {
            Condition::AtMost(limit) => (None, Some(limit)),
            Condition::AtLeast(limit) => (Some(limit), None),
            Condition::Between(from, to) => (Some(from), Some(to)),
        };
        json!({ "bit": bit.get(), "axis": axis.get(), "from": from, "to": to })
    };
    let connected = &show.machine.file.connected;
    let switches = connected.switches.iter().map(|one| switch(one.bit, one.axis, one.when));
    switches
        .chain(connected.probes.iter().map(|probe| switch(probe.bit, probe.axis, probe.touches)))
        .collect()
}

/// The bits that programs or the machine use, each with a name.
fn bits(show: &Show) -> Vec<Value> {
    let texts: Vec<String> =
        files(show).iter().filter_map(|path| Some(names::decode_text(&fs::read(path).ok()?))).collect();
    let mut used = names::bits_of(&texts);
    let mut note = |bit: Bit, is_input: bool| {
        let entry: &mut UsedBit = used.entry(bit).or_default();
        entry.is_read |= is_input;
        entry.is_written |= !is_input;
    };
    LAMPS.into_iter().filter_map(Bit::new).for_each(|bit| note(bit, false));
    let connected = &show.machine.file.connected;
    connected.switches.iter().for_each(|switch| note(switch.bit, true));
    connected.probes.iter().for_each(|probe| note(probe.bit, true));
    for wire in &show.machine.file.wires {
        note(wire.from, false);
        note(wire.to, true);
    }
    names::name_groups(&mut used);
    let places = places(show);
    let row = |(bit, used): (Bit, UsedBit)| {
        let range = show.machine.file.board.bit_range(bit);
        let is_input = match range.map(|range| range.direction) {
            Some(BitDirection::Input) => true,
            Some(BitDirection::Output) | None => false,
            Some(BitDirection::Programmable | BitDirection::Memory) => !used.is_written,
        };
        let about = places.get(&bit).cloned().or_else(|| range.map(|range| range.name.to_owned()));
        let name =
            used.name.unwrap_or_else(|| match LAMPS.iter().position(|lamp| *lamp == i32::from(bit.get())) {
                Some(lamp) => format!("LED {lamp}"),
                None => format!("bit {bit}"),
            });
        json!({ "bit": bit.get(), "name": name, "input": is_input, "about": about })
    };
    used.into_iter().map(row).collect()
}

/// Describes the equipment at each bit of the machine file.
fn places(show: &Show) -> BTreeMap<Bit, String> {
    let axis_name = |axis: AxisId| {
        let name = show.machine.file.axes.get(axis.index()).map_or("", |axis| &axis.name);
        if name.is_empty() { format!("axis {axis}") } else { name.to_owned() }
    };
    let words = |axis: AxisId, when: Condition| match when {
        Condition::AtMost(limit) => format!("{} ≤ {limit}", axis_name(axis)),
        Condition::AtLeast(limit) => format!("{} ≥ {limit}", axis_name(axis)),
        Condition::Between(from, to) => format!("{from} ≤ {} ≤ {to}", axis_name(axis)),
    };
    let connected = &show.machine.file.connected;
    let switches = connected.switches.iter().map(|one| (one.bit, words(one.axis, one.when)));
    switches.chain(connected.probes.iter().map(|one| (one.bit, words(one.axis, one.touches)))).collect()
}
