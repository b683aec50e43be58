//! The machine file: what is connected to the board, in TOML.
//!
//! Without one there are eight ideal axes and nothing else; each key changes one thing of that. Source: plant.md
//! section 9. Every error names the line and column it is about, and a misspelt key the one that was meant.

mod boards;
mod events;
mod pc;
mod read;
mod tables;

use std::fmt;
use std::path::Path;

use kmotiondef::limits::N_CHANNELS;
use kmotiondef::{AxisId, Bit};

use crate::pc::Answers;
use crate::world::stimulus::Stimulus;

/// Nanoseconds of a cycle of the board's processor, in which the costs of instructions are counted.
pub(crate) const NS_PER_INSTRUCTION: f64 = 5.0;

/// A machine.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFile {
    /// The eight axes.
    pub axes: [Axis; N_CHANNELS],
    /// Switches that axes trip.
    pub switches: Vec<Switch>,
    /// Probes.
    pub probes: Vec<Probe>,
    /// Encoders turned by hand.
    pub encoders: Vec<Handwheel>,
    /// Analog inputs.
    pub analog: Vec<Analog>,
    /// The spindle, if there is one.
    pub spindle: Option<Spindle>,
    /// Connections of outputs with inputs.
    pub wires: Vec<Wire>,
    /// What happens, and devices on pins.
    pub stimulus: Stimulus,
    /// SnapAmp boards on the bus.
    pub snapamps: usize,
    /// Whether a Kanalog is found at power-up.
    pub has_kanalog: bool,
    /// Inputs that read 1 while nothing drives them.
    pub idle_high: Vec<Bit>,
    /// Whether reading an input that nothing drives is worth a hint.
    pub hints: bool,
    /// Microseconds of the servo interrupt; what was measured if absent.
    pub servo_us: Option<f64>,
    /// Nanoseconds of an instruction on average.
    pub ns_per_instruction: f64,
    /// Ticks that a motion call plans before its motion begins.
    pub plan_ticks: u32,
    /// Whether a program that is started again finds its globals as they were loaded.
    pub fresh_globals: bool,
    /// Byte put into uninitialised data at a load.
    pub bss_fill: u8,
    /// Whether stacks are as small as the board's.
    pub strict_stack: bool,
    /// Whether the built-in PC polls and answers.
    pub host: bool,
    /// What it answers.
    pub answers: Answers,
    /// The folder of its files; `None` for the usual one.
    pub disk_root: Option<String>,
    /// How long a round trip to its files takes, seconds.
    pub disk_latency_s: f64,
    /// Names that programs use for its files, and the files meant, relative to the folder.
    pub disk_files: Vec<(String, String)>,
    /// Whether a KStep is on JP7, and whether its motors need the enable signal on bit 45.
    pub has_kstep: bool,
    /// See `has_kstep`.
    pub respect_enable: bool,
    /// Konnect boards that are there, a bit for each address: on JP4 and on JP6.
    pub konnects: [u8; 2],
    /// File that keeps the flash; `None` for this run only.
    pub flash: Option<String>,
    /// Whether reads of flash find the bank that `SetFlashBank` has selected, as the board's address lines have it.
    pub strict_flash: bool,
    /// File with the characters that the UART receives.
    pub uart_input: Option<String>,
    /// File for the characters that it sends.
    pub uart_output: Option<String>,
}

impl Default for MachineFile {
    fn default() -> Self {
        Self {
            axes: std::array::from_fn(|_| Axis::default()),
            switches: Vec::new(),
            probes: Vec::new(),
            encoders: Vec::new(),
            analog: Vec::new(),
            spindle: None,
            wires: Vec::new(),
            stimulus: Stimulus::default(),
            snapamps: 0,
            has_kanalog: false,
            idle_high: Vec::new(),
            hints: true,
            servo_us: None,
            ns_per_instruction: NS_PER_INSTRUCTION,
            plan_ticks: 0,
            fresh_globals: false,
            bss_fill: 0,
            strict_stack: false,
            host: true,
            answers: Answers::default(),
            disk_root: None,
            disk_latency_s: 0.02,
            disk_files: Vec::new(),
            has_kstep: false,
            respect_enable: false,
            konnects: [u8::MAX; 2],
            flash: None,
            strict_flash: false,
            uart_input: None,
            uart_output: None,
        }
    }
}

impl MachineFile {
    /// Reads a machine file.
    ///
    /// # Errors
    /// The first thing that is wrong, with its place.
    pub fn parse(text: &str) -> Result<Self, MachineFileError> {
        let mut machine = Self::default();
        tables::apply(&mut machine, text)?;
        Ok(machine)
    }

    /// Takes names of files that do not begin at a root as relative to `folder`, the one of the machine file.
    pub fn beside(&mut self, folder: &Path) {
        let names = [&mut self.disk_root, &mut self.flash, &mut self.uart_input, &mut self.uart_output];
        for name in names.into_iter().flatten() {
            *name = folder.join(&*name).to_string_lossy().into_owned();
        }
    }

    /// Changes one key, given as `axis.0.model=motor`: the path of the key, and a value with or without quotes.
    ///
    /// # Errors
    /// What is wrong with the key or its value.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), MachineFileError> {
        let plain = format!("{key} = {value}");
        let is_toml = toml::de::DeTable::parse(&plain).is_ok();
        let text = if is_toml { plain } else { format!("{key} = {value:?}") };
        let mut changed = self.clone();
        tables::apply(&mut changed, &text)?;
        *self = changed;
        Ok(())
    }
}

/// What is wrong with a machine file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct MachineFileError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong there.
    pub message: String,
}

/// How an axis' load moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// Goes where the axis commands, whatever its gains.
    Follow,
    /// Is driven by what the board really puts out.
    Motor,
    /// Nothing moves it.
    None,
}

/// Whether an axis' load turns its encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoder {
    /// So that the position follows the command.
    Auto,
    /// With `counts_per_unit`.
    Connected,
    /// No.
    Absent,
}

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What the user calls it.
    pub name: String,
    /// How its load moves.
    pub model: Model,
    /// Name of its unit.
    pub units: String,
    /// Encoder counts of a unit: the gearing.
    pub counts_per_unit: f64,
    /// Its encoder.
    pub encoder: Encoder,
    /// Time constant with which a load of the model `follow` follows, seconds.
    pub lag_s: f64,
    /// Hard stops, machine coordinates.
    pub min: f64,
    /// The other one.
    pub max: f64,
    /// Machine coordinate at power-up.
    pub start: f64,
    /// Its motor.
    pub motor: Motor,
    /// Electrical cycles of a unit; what the axis says if absent.
    pub cycles_per_unit: Option<f64>,
    /// Electrical angle of the rotor at machine coordinate 0, cycles.
    pub rotor_phase: f64,
    /// Its index pulse.
    pub index: Option<Index>,
}

impl Default for Axis {
    fn default() -> Self {
        Self {
            name: String::new(),
            model: Model::Follow,
            units: "counts".to_owned(),
            counts_per_unit: 1.0,
            encoder: Encoder::Auto,
            lag_s: 0.000_5,
            min: -1e9,
            max: 1e9,
            start: 0.0,
            motor: Motor::default(),
            cycles_per_unit: None,
            rotor_phase: -0.25,
            index: None,
        }
    }
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
}

impl Default for Motor {
    fn default() -> Self {
        Self { ku: None, tau_s: 0.02, friction: 0.0, ka: 2000.0, tau_v_s: 0.5, inertia: 1.0 }
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
    /// Where one begins.
    pub offset: f64,
}

/// Where a switch is active.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// At or below a coordinate.
    AtMost(f64),
    /// At or above one.
    AtLeast(f64),
    /// From one to another.
    Between(f64, f64),
}

impl Condition {
    /// Whether it holds at a machine coordinate.
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
    /// Where it is active.
    pub when: Condition,
    /// The level there.
    pub active: bool,
}

/// A probe that touches a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// The input it drives, 1 while it touches.
    pub bit: Bit,
    /// The axis that carries it.
    pub axis: AxisId,
    /// Where it touches.
    pub touches: Condition,
}

/// An encoder that is turned by hand.
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
    /// What it reads.
    pub source: AnalogSource,
}

/// What an analog input reads.
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
    /// What drives it.
    pub drive: SpindleDrive,
    /// Revolutions a second at full drive.
    pub full_scale_rps: f64,
    /// Time constant of its speed.
    pub tau_s: f64,
}

/// What drives a spindle.
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
    /// Whether it inverts.
    pub invert: bool,
    /// How late the input follows.
    pub delay_s: f64,
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Follow => "follow",
            Self::Motor => "motor",
            Self::None => "none",
        })
    }
}

#[cfg(test)]
mod tests;
