//! The places of a machine's description, for messages: the machine file and the lines in it.

use std::collections::BTreeMap;
use std::sync::Arc;

use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::{Axes, AxisId, Bit, Field};
use vm::memory::GuestMemory;

use super::description::{Axis, KeyPlace};
use super::mechanics::ConnectedEquipment;
use crate::views::TypedAccess;

/// Units of lengths and angles that equal several counts or steps of an axis.
const COARSE: &[&str] = &[
    "mm", "cm", "m", "in", "inch", "inches", "deg", "degree", "degrees", "°", "rev", "revs", "turn", "turns",
];

/// The places of a machine's description.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes {
    /// The name of the machine file.
    name: Option<Arc<str>>,
    axes: Vec<AxisNotes>,
    /// Switches and probes, with their bits.
    contacts: Vec<(Bit, KeyPlace)>,
}

/// The description of an axis.
#[derive(Clone, Debug)]
struct AxisNotes {
    keys: BTreeMap<String, KeyPlace>,
    /// A unit of length or angle that the file gives the axis.
    units: Option<String>,
    /// The distance between its hard stops, if it has two.
    travel: Option<f64>,
    /// True if a count of the encoder is a unit.
    counts_units: bool,
}

/// An axis that a program moves in steps or counts, although its machine file names another unit.
#[derive(Clone, Debug)]
pub(crate) struct UnitMismatch {
    /// The unit of the machine file.
    pub(crate) units: String,
    /// Its position in the file.
    pub(crate) place: String,
    /// The setting of the program by which its unit is a step or a count.
    pub(crate) field: &'static str,
    /// The unit of the program.
    pub(crate) unit: &'static str,
    /// The distance between the hard stops of the machine file, if it has two.
    pub(crate) travel: Option<f64>,
}

impl Notes {
    /// Takes the places of a machine's description.
    pub(crate) fn new(
        name: Option<Arc<str>>,
        axes: &[Axis; Axes::MAX],
        described: &ConnectedEquipment,
    ) -> Self {
        let switches = described.switches.iter().map(|switch| (switch.bit, switch.place));
        let probes = described.probes.iter().map(|probe| (probe.bit, probe.place));
        let contacts = switches.chain(probes).collect();
        Self { name, axes: axes.iter().map(AxisNotes::new).collect(), contacts }
    }

    /// Returns whether the machine file describes an axis.
    pub(crate) fn has_axis(&self, axis: AxisId) -> bool {
        self.axis(axis).is_some_and(|notes| !notes.keys.is_empty())
    }

    /// The key of an axis with its location, as in messages; only its name if nothing sets it.
    pub(crate) fn key(&self, axis: AxisId, key: &str) -> String {
        match self.axis(axis).and_then(|notes| notes.keys.get(key)) {
            Some(KeyPlace::Option) => format!("--set axis.{axis}.{key}"),
            Some(place) => format!("axis.{axis}.{key}, {}", self.shown(*place)),
            None => format!("axis.{axis}.{key}"),
        }
    }

    /// The place of a switch or probe, as messages have it.
    pub(crate) fn contact(&self, bit: Bit) -> Option<String> {
        let (_, place) = self.contacts.iter().find(|(other, _)| *other == bit)?;
        Some(self.shown(*place))
    }

    /// The unit of the machine file, if it cannot be the unit in which a program moves an axis.
    pub(crate) fn other_units(&self, memory: &GuestMemory, axis: AxisId) -> Option<UnitMismatch> {
        let notes = self.axis(axis)?;
        let units = notes.units.clone()?;
        let (field, unit) = unit(memory, axis).filter(|(_, unit)| *unit == STEPS || notes.counts_units)?;
        let place = self.shown(*notes.keys.get("units")?);
        Some(UnitMismatch { units, place, field, unit, travel: notes.travel })
    }

    fn axis(&self, axis: AxisId) -> Option<&AxisNotes> {
        self.axes.get(axis.index())
    }

    fn shown(&self, place: KeyPlace) -> String {
        match (place, &self.name) {
            (KeyPlace::Line(line), Some(name)) => format!("{name}:{line}"),
            (KeyPlace::Line(line), None) => format!("line {line} of the machine file"),
            (KeyPlace::Option, _) => "--set".to_owned(),
        }
    }
}

impl AxisNotes {
    fn new(axis: &Axis) -> Self {
        let has_ends = ["min", "max"].into_iter().all(|key| axis.keys.contains_key(key));
        Self {
            keys: axis.keys.clone(),
            units: Some(axis.units.clone()).filter(|units| COARSE.contains(&units.to_lowercase().as_str())),
            travel: has_ends.then_some(axis.travel.max - axis.travel.min),
            counts_units: axis.counts_per_unit.abs() == 1.0,
        }
    }
}

/// The unit of an axis with a step generator.
const STEPS: &str = "steps";

/// The unit in which a program moves an axis, if a gain of 1 makes it a step or a count; and the field of that gain.
fn unit(memory: &GuestMemory, axis: AxisId) -> Option<(&'static str, &'static str)> {
    let mode =
        OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE)).filter(|mode| *mode != OutputMode::None)?;
    let is_one = |field: Field<f32>| memory.axis(axis, field).abs() == 1.0;
    let has_encoder = memory.axis(axis, Chan::INPUT_MODE) == InputMode::Encoder.get();
    if OutputMode::has_generator(Some(mode)) && OutputMode::is_open_loop(Some(mode)) {
        is_one(Chan::OUTPUT_GAIN).then_some(("OutputGain", STEPS))
    } else {
        (has_encoder && is_one(Chan::INPUT_GAIN0)).then_some(("InputGain0", "counts"))
    }
}
