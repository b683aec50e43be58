//! Values that can be sampled, by name.

use std::fmt;

use kmotiondef::bits::{BitKind, range_of};
use kmotiondef::modes::GatherType;
use kmotiondef::structs::{Chan, Persist};
use kmotiondef::variables::{ADC_BUFFER_IN, DAC_BUFFER, LAST_PWM, PERSIST};
use kmotiondef::{Axes, AxisId, Bit, Place};

use super::{Formula, RecordedCell, View};
use crate::io::bits::bit_state;
use crate::io::kanalog::conversion;
use crate::io::konnect::{KonnectBoard, Port};
use crate::views::{self, TypedAccess};

/// A kind of value: a row of the table of kinds, which defines all of its properties.
struct ItemKind {
    name: &'static str,
    /// The number of items, which are numbered from 0.
    count: usize,
    /// True if there is one for each axis of the board, whatever the count.
    is_by_axis: bool,
    /// The unit; empty for mere numbers.
    unit: &'static str,
    /// True if `axisN` includes it.
    is_of_axes: bool,
    read: fn(&View<'_>, usize) -> f64,
    /// The variable of the board that holds it; `None` if it is only in registers, or in the model.
    cell: Option<fn(usize) -> RecordedCell>,
}

/// A kind of eight items that `axisN` does not include.
const OTHER: ItemKind = ItemKind {
    name: "",
    count: 8,
    is_by_axis: false,
    unit: "",
    is_of_axes: false,
    read: |_, _| 0.0,
    cell: None,
};

/// A kind that is numbered by axis.
const BY_AXIS: ItemKind = ItemKind { is_by_axis: true, ..OTHER };

impl ItemKind {
    /// The number of items on a board.
    const fn count_on(&self, axes: Axes) -> usize {
        if self.is_by_axis { axes.count() } else { self.count }
    }
}

/// All kinds.
const KINDS: &[ItemKind] = &[
    // Where an axis is sent.
    ItemKind {
        name: "dest",
        unit: "units",
        is_of_axes: true,
        read: |view, index| view.memory.axis(axis(index), Chan::DEST),
        cell: Some(|index| RecordedCell::new(chan(index).field(Chan::DEST).address(), GatherType::Double)),
        ..BY_AXIS
    },
    // The position.
    ItemKind {
        name: "pos",
        unit: "units",
        is_of_axes: true,
        read: |view, index| view.memory.axis(axis(index), Chan::POSITION),
        cell: Some(|index| {
            RecordedCell::new(chan(index).field(Chan::POSITION).address(), GatherType::Double)
        }),
        ..BY_AXIS
    },
    // The drive.
    ItemKind {
        name: "out",
        is_of_axes: true,
        read: |view, index| view.memory.axis(axis(index), Chan::OUTPUT).into(),
        cell: Some(|index| RecordedCell::new(chan(index).field(Chan::OUTPUT).address(), GatherType::Float)),
        ..BY_AXIS
    },
    // The commanded velocity.
    ItemKind {
        name: "vel",
        unit: "units/s",
        read: |view, index| view.memory.axis(axis(index), Chan::LAST_VEL).into(),
        cell: Some(|index| RecordedCell::new(chan(index).field(Chan::LAST_VEL).address(), GatherType::Float)),
        ..BY_AXIS
    },
    // Where its load is, in machine coordinates.
    ItemKind { name: "load", unit: "units", read: |view, index| view.machine.table(axis(index)), ..BY_AXIS },
    // A bit.
    ItemKind { name: "bit", count: Bit::MAX as usize + 1, read: bit, ..OTHER },
    // An analog input, -2048 to 2047.
    ItemKind {
        name: "adc",
        unit: "counts",
        read: |view, index| f64::from(conversion(view.memory, index) - 2048),
        cell: Some(|index| RecordedCell {
            offset: -2048.0,
            ..RecordedCell::new(ADC_BUFFER_IN.element(index).address(), GatherType::Int)
        }),
        ..OTHER
    },
    // An analog output, -2048 to 2047.
    ItemKind { name: "dac", unit: "counts", read: dac, ..OTHER },
    // The word sent to an amplifier.
    ItemKind {
        name: "pwm",
        count: 16,
        read: |view, index| view.memory.get(LAST_PWM.element(index)).into(),
        ..OTHER
    },
    // The duty of an I/O PWM from 0 to 1, and its frequency; 0 while it is off.
    ItemKind {
        name: "iopwm",
        read: |view, index| view.io.fpga.pwm(index as u32).unwrap_or_default().0,
        ..OTHER
    },
    ItemKind {
        name: "iopwmhz",
        unit: "Hz",
        read: |view, index| view.io.fpga.pwm(index as u32).unwrap_or_default().1,
        ..OTHER
    },
    // Steps made by a generator.
    ItemKind { name: "step", unit: "steps", read: |view, index| view.io.stepgens.position(index), ..OTHER },
    // The outputs of a Konnect board: 0 to 7 on JP6, 8 to 15 on JP4.
    ItemKind { name: "konnect", count: 16, read: konnect, ..OTHER },
    // The analog output of a KStep, as part of its supply.
    ItemKind {
        name: "kstep_analog",
        count: 1,
        read: |view, _| view.io.fpga.kstep_output().level(view.tick_start),
        ..OTHER
    },
    // An element of `persist.UserData`.
    ItemKind {
        name: "persist",
        count: 200,
        read: user_data,
        cell: Some(|index| {
            let element = PERSIST.field(Persist::USER_DATA).element(index);
            RecordedCell::new(element.address(), GatherType::Int)
        }),
        ..OTHER
    },
];

/// The variables of an axis.
fn chan(index: usize) -> Place<Chan> {
    views::chan(axis(index))
}

/// Indexes are checked when a name is read.
fn axis(index: usize) -> AxisId {
    AxisId::all().nth(index).unwrap_or_else(|| AxisId::all().next_back().expect("there are axes"))
}

fn bit(view: &View<'_>, index: usize) -> f64 {
    let bit = i32::try_from(index).ok().and_then(Bit::new);
    bit.map_or(0.0, |bit| f64::from(u8::from(bit_state(view.io, view.memory, bit).0)))
}

fn dac(view: &View<'_>, index: usize) -> f64 {
    f64::from((i32::from(view.memory.get(DAC_BUFFER.element(index))) & 0xfff) - 2048)
}

fn konnect(view: &View<'_>, index: usize) -> f64 {
    let port = if index < 8 { Port::Aux1 } else { Port::Aux0 };
    view.io.konnects.outputs(KonnectBoard { port, address: (index % 8) as u8 }).into()
}

fn user_data(view: &View<'_>, index: usize) -> f64 {
    view.memory.get(PERSIST.field(Persist::USER_DATA).element(index)).into()
}

/// A value that can be sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Item {
    kind: usize,
    index: usize,
}

/// A name that is not one of an item.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` is not an item; known: {known}")]
pub struct UnknownItem {
    /// The name.
    pub name: String,
    /// Those that exist.
    pub known: String,
}

impl Item {
    /// The item of a name such as `dest0` or `bit46` on the default board.
    ///
    /// # Errors
    /// A name that is not one.
    pub fn new(name: &str) -> Result<Self, UnknownItem> {
        Self::among(Axes::default(), name)
    }

    /// The item of a name on a board with these axes.
    ///
    /// # Errors
    /// A name that is not one.
    pub fn among(axes: Axes, name: &str) -> Result<Self, UnknownItem> {
        // `persist.5` is how `--set` calls it.
        let name = &name.replacen("persist.", "persist", 1);
        let letters = name.trim_end_matches(|character: char| character.is_ascii_digit());
        let kind = KINDS.iter().position(|kind| kind.name == letters);
        // A kind with a single item has no number.
        let is_single = kind.is_some_and(|kind| KINDS[kind].count == 1) && letters.len() == name.len();
        let index = if is_single { Some(0) } else { name[letters.len()..].parse().ok() };
        if let (Some(kind), Some(index)) = (kind, index)
            && index < KINDS[kind].count_on(axes)
        {
            return Ok(Self { kind, index });
        }
        let is_near = |other: &&ItemKind| kind.is_none_or(|kind| KINDS[kind].name == other.name);
        let known: Vec<_> = KINDS
            .iter()
            .filter(is_near)
            .map(|kind| match kind.count_on(axes) {
                1 => kind.name.to_owned(),
                count => format!("{}0 to {0}{}", kind.name, count - 1),
            })
            .collect();
        Err(UnknownItem { name: name.clone(), known: known.join(", ") })
    }

    /// The item that a bit is.
    #[must_use]
    pub fn of_bit(bit: Bit) -> Self {
        Self {
            kind: KINDS.iter().position(|kind| kind.name == "bit").unwrap_or_default(),
            index: bit.index(),
        }
    }

    /// Returns whether there are numbered items of this name.
    #[must_use]
    pub fn is_kind(name: &str) -> bool {
        KINDS.iter().any(|kind| kind.name == name)
    }

    /// Returns the commanded position, the position and the output of every axis of a board.
    #[must_use]
    pub fn of_axes(axes: Axes) -> Vec<Self> {
        axes.iter().flat_map(Self::of_axis).collect()
    }

    /// All that `axisN` names.
    #[must_use]
    pub fn of_axis(axis: AxisId) -> Vec<Self> {
        let kinds = KINDS.iter().enumerate().filter(|(_, kind)| kind.is_of_axes);
        kinds.map(|(kind, _)| Self { kind, index: axis.index() }).collect()
    }

    /// Returns the load position of every axis of a board, in machine coordinates.
    #[must_use]
    pub fn of_loads(axes: Axes) -> Vec<Self> {
        axes.iter().flat_map(|axis| Self::among(axes, &format!("load{axis}"))).collect()
    }

    /// Returns the kind of value: its name without the number.
    #[must_use]
    pub fn kind(self) -> &'static str {
        KINDS[self.kind].name
    }

    /// Its number among those of its kind.
    #[must_use]
    pub const fn index(self) -> usize {
        self.index
    }

    /// The unit of the value; empty for mere numbers.
    #[must_use]
    pub fn unit(self) -> &'static str {
        KINDS[self.kind].unit
    }

    /// The axis to which it belongs, if it is one of [`of_axes`](Self::of_axes).
    #[must_use]
    pub fn axis(self) -> Option<usize> {
        KINDS[self.kind].is_of_axes.then_some(self.index)
    }

    /// The bit, if it is a bit.
    #[must_use]
    pub fn bit(self) -> Option<Bit> {
        Bit::new(i32::try_from(self.index).ok()?).filter(|_| self.kind() == "bit")
    }

    /// Returns whether it belongs to an option board that only the modelled firmware serves: a Konnect, a SnapAmp.
    #[must_use]
    pub fn is_only_modelled(self) -> bool {
        let is_snapamp = |bit| range_of(bit).is_some_and(|range| range.kind == BitKind::SnapGpio);
        self.kind() == "konnect" || self.bit().is_some_and(is_snapamp)
    }

    pub(crate) fn read(self, view: &View<'_>) -> f64 {
        (KINDS[self.kind].read)(view, self.index)
    }
}

impl Formula for Item {
    fn value(&self, view: &View<'_>) -> f64 {
        self.read(view)
    }

    fn items(&self) -> &[Item] {
        std::slice::from_ref(self)
    }

    fn cell(&self) -> Option<RecordedCell> {
        KINDS[self.kind].cell.map(|cell| cell(self.index))
    }
}

impl fmt::Display for Item {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match KINDS[self.kind] {
            ItemKind { name, count: 1, .. } => formatter.write_str(name),
            ItemKind { name, .. } => write!(formatter, "{name}{}", self.index),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written() {
        for name in
            ["dest0", "bit2047", "iopwm7", "iopwmhz0", "persist199", "step7", "konnect15", "kstep_analog"]
        {
            assert_eq!(Item::new(name).map(|item| item.to_string()).as_deref(), Ok(name));
        }
        for name in ["dest8", "dest", "0", "", "speed0", "bit2048", "bit-1", "é0", "kstep_analog1"] {
            assert_eq!(Item::new(name).map_err(|error| error.name), Err(name.to_owned()));
        }
    }
}
