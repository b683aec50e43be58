//! One entry of a path: its address in guest memory and its contents.

use kmotiondef::modes::TrajectoryMode;
use kmotiondef::structs::{ParametricCoeff, TripCircleLinear, TripLinear};
use kmotiondef::{AxisId, Bit, Field, GuestAddr, GuestType, Place};
use vm::memory::GuestMemory;

use super::system::LETTERS;
use crate::arithmetic::doubles::sin;
use crate::views::TypedAccess;

/// Bytes of an entry.
pub(crate) const SIZE: u32 = ParametricCoeff::SIZE;

/// The letters whose position is always linear in the parameter, with their axes.
const LINEAR_LETTERS: [(Field<u8>, Field<TripLinear>); 6] = [
    (ParametricCoeff::Z_AXIS, ParametricCoeff::COORD_Z),
    (ParametricCoeff::A_AXIS, ParametricCoeff::COORD_A),
    (ParametricCoeff::B_AXIS, ParametricCoeff::COORD_B),
    (ParametricCoeff::C_AXIS, ParametricCoeff::COORD_C),
    (ParametricCoeff::U_AXIS, ParametricCoeff::COORD_U),
    (ParametricCoeff::V_AXIS, ParametricCoeff::COORD_V),
];

/// The letters that an arc moves.
const ARC_LETTERS: [(Field<u8>, Field<TripCircleLinear>); 2] = [
    (ParametricCoeff::X_AXIS, ParametricCoeff::COORD_X),
    (ParametricCoeff::Y_AXIS, ParametricCoeff::COORD_Y),
];

/// The kind of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The end of the path; so is any mode without a meaning.
    Off,
    /// A segment of the path.
    Segment(Shape),
    /// A command that takes no path time.
    Command(Command),
}

/// The form of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Every letter is linear in the parameter.
    Linear,
    /// X and Y are sines of it.
    Circular,
}

/// A command in the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Command {
    /// Drives a bit.
    Drive(Bit, bool),
    /// Holds the path until a bit has a state.
    Wait(Bit, bool),
    /// From here on the rapid override applies, or no longer.
    Rapid(bool),
    /// A number or a bit without a meaning.
    Nothing,
}

impl Command {
    /// The command's number and bit as an entry holds them.
    pub(crate) fn encode(self) -> (u8, i16) {
        match self {
            Self::Drive(bit, high) => (u8::from(high), bit.get() as i16),
            Self::Wait(bit, high) => (2 + u8::from(high), bit.get() as i16),
            Self::Rapid(begins) => (5 - u8::from(begins), 0),
            Self::Nothing => (u8::MAX, 0),
        }
    }

    fn decode(number: u8, bit: i16) -> Self {
        let bit = Bit::new(i32::from(bit));
        match (number, bit) {
            (0 | 1, Some(bit)) => Self::Drive(bit, number == 1),
            (2 | 3, Some(bit)) => Self::Wait(bit, number == 3),
            (4 | 5, _) => Self::Rapid(number == 4),
            _ => Self::Nothing,
        }
    }
}

/// An entry of a path, by its address.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry(Place<ParametricCoeff>);

impl Entry {
    /// The entry at an address, whatever its contents.
    pub(crate) const fn at(address: GuestAddr) -> Self {
        Self(Place::new(address))
    }

    /// Returns its address.
    pub(crate) const fn address(self) -> GuestAddr {
        self.0.address()
    }

    /// A field of it.
    pub(crate) const fn field<T>(self, field: Field<T>) -> Place<T> {
        self.0.field(field)
    }

    /// Returns its kind.
    pub(crate) fn kind(self, memory: &GuestMemory) -> Kind {
        let mode = i32::from(memory.get(self.field(ParametricCoeff::TRAJECTORY_MODE)));
        match TrajectoryMode::new(mode) {
            Some(TrajectoryMode::Linear) => Kind::Segment(Shape::Linear),
            Some(TrajectoryMode::Circular) => Kind::Segment(Shape::Circular),
            Some(TrajectoryMode::Special) => Kind::Command(Command::decode(
                memory.get(self.field(ParametricCoeff::X_AXIS)),
                memory.get(self.field(ParametricCoeff::SPECIAL_PARAM)),
            )),
            _ => Kind::Off,
        }
    }

    /// Makes it the end of the path.
    pub(crate) fn end_path(self, memory: &mut GuestMemory) {
        memory.set(self.field(ParametricCoeff::TRAJECTORY_MODE), TrajectoryMode::Off.get() as i8);
    }

    /// Its duration in seconds of path time; 0 unless it is a segment.
    pub(crate) fn duration(self, memory: &GuestMemory) -> f64 {
        match self.kind(memory) {
            Kind::Segment(_) => memory.get(self.field(ParametricCoeff::T)),
            Kind::Off | Kind::Command(_) => 0.0,
        }
    }

    /// Returns the axes of its letters.
    pub(crate) fn axes(self, memory: &GuestMemory) -> [Option<AxisId>; LETTERS] {
        let fields =
            ARC_LETTERS.map(|(field, _)| field).into_iter().chain(LINEAR_LETTERS.map(|(field, _)| field));
        let mut axes = fields.map(|field| memory.axes().get(i32::from(memory.get(self.field(field)))));
        std::array::from_fn(|_| axes.next().flatten())
    }

    /// Returns the positions of the axes `t` seconds into the segment.
    pub(crate) fn positions(self, memory: &GuestMemory, t: f64) -> [Option<(AxisId, f64)>; LETTERS] {
        let Kind::Segment(shape) = self.kind(memory) else { return [None; LETTERS] };
        let p = self.parameter(memory, t);
        let axis = |field: Field<u8>| memory.axes().get(i32::from(memory.get(self.field(field))));
        std::array::from_fn(|index| match ARC_LETTERS.get(index) {
            Some(&(letter, coefficients)) => {
                axis(letter).map(|axis| (axis, self.on_arc(memory, coefficients, shape, p)))
            }
            None => {
                let (letter, coefficients) = LINEAR_LETTERS[index - ARC_LETTERS.len()];
                let value = |field| memory.get(self.field(coefficients.field(field)));
                axis(letter).map(|axis| (axis, value(TripLinear::C) * p + value(TripLinear::D)))
            }
        })
    }

    /// The parameter at `t`, a cubic of time.
    fn parameter(self, memory: &GuestMemory, t: f64) -> f64 {
        let value = |field| memory.get(self.field(field));
        let [a, b, c, d] =
            [ParametricCoeff::A, ParametricCoeff::B, ParametricCoeff::C, ParametricCoeff::D].map(value);
        ((a * t + b) * t + c) * t + d
    }

    fn on_arc(
        self,
        memory: &GuestMemory,
        coefficients: Field<TripCircleLinear>,
        shape: Shape,
        p: f64,
    ) -> f64 {
        let value = |field| memory.get(self.field(coefficients.field(field)));
        let (c, d) = (value(TripCircleLinear::C), value(TripCircleLinear::D));
        match shape {
            Shape::Linear => c * p + d,
            Shape::Circular => c * sin(p * value(TripCircleLinear::A) + value(TripCircleLinear::B)) + d,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_read_back_from_their_entries() {
        let bit = Bit::new(1040).expect("a bit");
        for command in [
            Command::Drive(bit, false),
            Command::Drive(bit, true),
            Command::Wait(bit, false),
            Command::Wait(bit, true),
            Command::Rapid(true),
            Command::Rapid(false),
            Command::Nothing,
        ] {
            let (number, bit) = command.encode();
            assert_eq!(Command::decode(number, bit), command);
        }
        assert_eq!(Command::decode(1, -1), Command::Nothing);
        assert_eq!(Command::decode(6, 0), Command::Nothing);
    }

    #[test]
    fn an_entry_outside_memory_ends_the_path() {
        let memory = GuestMemory::new();
        for address in [0, 0x4000_0000, 0xFFFF_FFF0] {
            assert_eq!(Entry::at(GuestAddr::new(address)).kind(&memory), Kind::Off);
        }
    }
}
