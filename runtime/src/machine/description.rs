//! The machine as a machine file describes it: loads, switches, probes, sources, a spindle, wires.

use std::collections::BTreeMap;
use std::fmt;

use kmotiondef::{AxisId, Bit};

macro_rules! models {
    ($($(#[doc = $doc:literal])+ $name:ident = $word:literal,)*) => {
        /// The motion model of an axis' load.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Model {
            $($(#[doc = $doc])+ $name,)*
        }

        impl Model {
            /// All of them, as a machine file calls them.
            pub const NAMED: &[(&str, Self)] = &[$(($word, Self::$name)),*];
        }

        impl fmt::Display for Model {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self {
                    $(Self::$name => $word,)*
                })
            }
        }
    };
}

models! {
    /// Follows the axis' command with any gains.
    Follow = "follow",
    /// Is driven by what the board really outputs.
    Motor = "motor",
    /// Nothing moves it.
    None = "none",
}

/// The source of an axis' encoder counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoder {
    /// So that the position follows the command.
    Auto,
    /// With `counts_per_unit`.
    Connected,
    /// No.
    Absent,
}

/// The connections of an axis' encoder and motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Connection {
    /// The encoder.
    pub encoder: Encoder,
    /// The input to which the encoder is connected, if the machine file gives it.
    pub input: Option<usize>,
    /// The output that drives the motor, if the machine file names it.
    pub drive: Option<Channel>,
}

impl Default for Connection {
    fn default() -> Self {
        Self { encoder: Encoder::Auto, input: None, drive: None }
    }
}

/// An output that drives a motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// An analog output of a Kanalog.
    Dac(usize),
    /// A step generator.
    Generator(usize),
    /// A PWM channel; channels from 8 on belong to the SnapAmps.
    Pwm(usize),
    /// Two outputs, mostly relays: forward, and back.
    Relays(Bit, Bit),
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dac(number) => write!(f, "DAC {number}"),
            Self::Generator(number) => write!(f, "step generator {number}"),
            Self::Pwm(number) => write!(f, "PWM channel {number}"),
            Self::Relays(forward, back) => write!(f, "outputs {forward} and {back}"),
        }
    }
}

/// The unit of an axis that has no other.
const COUNTS: &str = "counts";

/// The place where a machine is described.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyPlace {
    /// A line of the machine file, from 1.
    Line(usize),
    /// An option that sets a key.
    Option,
}

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The keys that describe it, with the last place of each.
    pub keys: BTreeMap<String, KeyPlace>,
    /// The user's name for the axis.
    pub name: String,
    /// The motion model of its load.
    pub model: Model,
    /// Name of its unit.
    pub units: String,
    /// Encoder counts of a unit: the gearing.
    pub counts_per_unit: f64,
    /// Its encoder and its drive.
    pub connection: Connection,
    /// Time constant with which a load of the model `follow` follows, seconds.
    pub lag_s: f64,
    /// The range of its load.
    pub travel: Travel,
    /// Its motor.
    pub motor: Motor,
    /// The mounting of its rotor.
    pub rotor: Rotor,
    /// Its index pulse.
    pub index: Option<Index>,
}

impl Axis {
    /// Returns whether its encoder counts such that the position follows the command, whatever the gain.
    pub(crate) fn follows_gain(&self) -> bool {
        (self.connection.encoder, self.model) == (Encoder::Auto, Model::Follow)
    }

    /// Returns its name and its unit; empty if they were not given.
    pub(crate) fn names(&self) -> (String, String) {
        let units = if self.units == COUNTS { String::new() } else { self.units.clone() };
        (self.name.clone(), units)
    }
}

impl Default for Axis {
    fn default() -> Self {
        Self {
            keys: BTreeMap::new(),
            name: String::new(),
            model: Model::Follow,
            units: COUNTS.to_owned(),
            counts_per_unit: 1.0,
            connection: Connection::default(),
            lag_s: 0.000_5,
            travel: Travel::default(),
            motor: Motor::default(),
            rotor: Rotor::default(),
            index: None,
        }
    }
}

/// The range of a load, in machine coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// The lower hard stop.
    pub min: f64,
    /// The upper hard stop.
    pub max: f64,
    /// Machine coordinate at power-up.
    pub start: f64,
    /// Backlash between the load and the table that trips switches and probes, units.
    pub backlash: f64,
    /// The spring between the load and that table.
    pub spring: Option<Spring>,
}

impl Default for Travel {
    fn default() -> Self {
        Self { min: -1e9, max: 1e9, start: 0.0, backlash: 0.0, spring: None }
    }
}

/// A spring between the load of a motor and the table: a belt, a long screw, a column that bends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Frequency in Hz at which the table swings, from above 0 to 500.
    pub hz: f64,
    /// Damping ratio: at 0 the table swings forever, from 1 on it does not swing at all.
    pub damping: f64,
}

/// Two motors that move one beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gantry {
    /// Their axes.
    pub axes: [AxisId; 2],
    /// The difference in units that the beam tolerates.
    pub most: f64,
}

/// A motor with its load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Units a second for one PWM or DAC count; 435 and 50 if absent.
    pub ku: Option<f64>,
    /// Mechanical time constant in seconds, for the motor alone.
    pub tau_s: f64,
    /// Coulomb friction in units a second of lost speed.
    pub friction: f64,
    /// Units a second squared for one count of current.
    pub ka: f64,
    /// Time constant of viscous friction under a current drive, seconds.
    pub tau_v_s: f64,
    /// Inertia of motor and load, in inertias of the motor.
    pub inertia: f64,
    /// Units a second that a constant load such as a weight adds to the speed.
    pub pull: f64,
}

impl Default for Motor {
    fn default() -> Self {
        Self { ku: None, tau_s: 0.02, friction: 0.0, ka: 2000.0, tau_v_s: 0.5, inertia: 1.0, pull: 0.0 }
    }
}

/// The connection of a brushless motor's rotor to its load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    /// Electrical cycles of a unit; the axis' own value if absent.
    pub cycles_per_unit: Option<f64>,
    /// Electrical angle at machine coordinate 0, cycles.
    pub phase: f64,
}

impl Default for Rotor {
    fn default() -> Self {
        Self { cycles_per_unit: None, phase: -0.25 }
    }
}

/// An index pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    /// The bit that is 1 during the pulse.
    pub bit: Bit,
    /// Units from pulse to pulse.
    pub every: f64,
    /// Units of a pulse.
    pub width: f64,
    /// The position of the first pulse.
    pub offset: f64,
}

/// The range of positions in which a switch is active.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// At or below a coordinate.
    AtMost(f64),
    /// At or above one.
    AtLeast(f64),
    /// From one to another.
    Between(f64, f64),
}

impl fmt::Display for Condition {
    /// "at ≤ -200".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtMost(place) => write!(f, "at ≤ {place}"),
            Self::AtLeast(place) => write!(f, "at ≥ {place}"),
            Self::Between(from, to) => write!(f, "from {from} to {to}"),
        }
    }
}

impl Condition {
    /// The end of a travel that a load must pass to reach the switch: its key in the machine file, and its position.
    pub(crate) fn beyond(self, travel: &Travel) -> Option<(&'static str, f64)> {
        let Travel { min, max, .. } = *travel;
        let (from, to) = match self {
            Self::AtMost(to) => (f64::NEG_INFINITY, to),
            Self::AtLeast(from) => (from, f64::INFINITY),
            Self::Between(from, to) => (from, to),
        };
        if to < min { Some(("min", min)) } else { (from > max).then_some(("max", max)) }
    }

    /// Returns whether the condition holds at a machine coordinate.
    #[must_use]
    pub fn holds(self, coordinate: f64) -> bool {
        match self {
            Self::AtMost(limit) => coordinate <= limit,
            Self::AtLeast(limit) => coordinate >= limit,
            Self::Between(from, to) => (from..=to).contains(&coordinate),
        }
    }
}

/// A switch that an axis trips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// The input it drives.
    pub bit: Bit,
    /// The axis.
    pub axis: AxisId,
    /// The range in which it is active.
    pub when: Condition,
    /// The level while it is active.
    pub active: bool,
    /// The place of its description.
    pub place: KeyPlace,
}

/// A probe that touches a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// The input it drives, 1 while it touches.
    pub bit: Bit,
    /// The axis that carries it.
    pub axis: AxisId,
    /// The range in which it touches.
    pub touches: Condition,
    /// The place of its description.
    pub place: KeyPlace,
}

/// An encoder turned by hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Handwheel {
    /// Its input channel.
    pub channel: usize,
    /// Start in seconds, counts, duration in seconds; in steady motion.
    pub moves: Vec<[f64; 3]>,
}

/// A source of an analog input, in its counts, −2048 to 2047.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Analog {
    /// The input.
    pub channel: usize,
    /// The signal at the input.
    pub source: AnalogSource,
}

/// The signal at an analog input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnalogSource {
    /// A constant.
    Value(f64),
    /// A sine: mean, amplitude, frequency.
    Sine {
        /// Its mean.
        mean: f64,
        /// Its amplitude.
        amp: f64,
        /// Its frequency.
        hz: f64,
    },
    /// A line of an axis' machine coordinate.
    Follows {
        /// The axis.
        axis: AxisId,
        /// Counts of a unit.
        gain: f64,
        /// Counts at 0.
        offset: f64,
    },
}

/// A spindle with its drive and encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spindle {
    /// The axis whose encoder it turns.
    pub axis: AxisId,
    /// Counts of a revolution.
    pub counts_per_rev: f64,
    /// The output that drives it.
    pub drive: SpindleDrive,
    /// Revolutions a second at full drive.
    pub full_scale_rps: f64,
    /// Time constant of its speed.
    pub tau_s: f64,
    /// Revolutions per second that it loses under full load.
    pub droop_rps: f64,
    /// Its load, from 0 to 1.
    pub load: f64,
}

/// The output that drives a spindle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleDrive {
    /// The analog output of an axis.
    Axis(AxisId),
    /// An analog output.
    Dac(usize),
    /// Two outputs, clockwise and back.
    Bits {
        /// Full speed forward.
        cw: Bit,
        /// Full speed back.
        ccw: Bit,
    },
}

/// A connection from an output to an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wire {
    /// The output.
    pub from: Bit,
    /// The input.
    pub to: Bit,
    /// True if it inverts.
    pub invert: bool,
    /// The delay of the input.
    pub delay_s: f64,
}
