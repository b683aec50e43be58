//! The modes and kinds that fields of the guest's structures hold as numbers.
//!
//! A program may store any number; one without a meaning is `None`, and the board then does
//! nothing.

macro_rules! modes {
    ($(
        $(#[$doc:meta])+
        $mode:ident { $($(#[$variant_doc:meta])+ $variant:ident = $name:ident $value:literal,)* }
    )*) => {
        $(
            $(#[$doc])+
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            #[repr(i32)]
            pub enum $mode {
                $($(#[$variant_doc])+ $variant = $value,)*
            }

            impl $mode {
                /// The mode with a number.
                #[must_use]
                pub const fn new(number: i32) -> Option<Self> {
                    match number {
                        $($value => Some(Self::$variant),)*
                        _ => None,
                    }
                }

                /// The number a program sees.
                #[must_use]
                pub const fn get(self) -> i32 {
                    self as i32
                }
            }
        )*

        #[cfg(test)]
        const ALL: &[(&str, i32)] = &[$($((stringify!($name), $value)),*),*];
    };
}

modes! {
    /// The source of an axis' position: `CHAN.InputMode`.
    InputMode {
        /// Nowhere.
        None = NO_INPUT_MODE 0,
        /// A quadrature encoder.
        Encoder = ENCODER_MODE 1,
        /// An analog input.
        Adc = ADC_MODE 2,
        /// A resolver or sine/cosine encoder.
        Resolver = RESOLVER_MODE 3,
        /// A program writes it.
        User = USER_INPUT_MODE 4,
    }

    /// The output that an axis drives: `CHAN.OutputMode`.
    OutputMode {
        /// Nothing.
        None = NO_OUTPUT_MODE 0,
        /// A stepper with sine and cosine currents.
        Microstep = MICROSTEP_MODE 1,
        /// A brushed motor.
        DcServo = DC_SERVO_MODE 2,
        /// A three-phase brushless motor.
        Brushless3Ph = BRUSHLESS_3PH_MODE 3,
        /// A brushless motor of four phases, two coils.
        Brushless4Ph = BRUSHLESS_4PH_MODE 4,
        /// An analog output to an external amplifier.
        DacServo = DAC_SERVO_MODE 5,
        /// Step and direction, open loop.
        StepDir = STEP_DIR_MODE 6,
        /// Step and direction, closed loop.
        ClosedLoopStepDir = CL_STEP_DIR_MODE 7,
        /// Microstepping, closed loop.
        ClosedLoopMicrostep = CL_MICROSTEP_MODE 8,
    }

    /// The compensation of backlash: `CHAN.BacklashMode`.
    BacklashMode {
        /// No compensation.
        Off = BACKLASH_OFF 0,
        /// At a constant rate.
        Linear = BACKLASH_LINEAR 1,
    }

    /// The action of an entry of a profile or of the coordinated-motion buffer: `trajectory_mode`.
    TrajectoryMode {
        /// The end of the list.
        Off = TRAJECTORY_OFF 0,
        /// A third-order profile of one axis.
        Independent = TRAJECTORY_INDEPENDENT 1,
        /// A coordinated straight line.
        Linear = TRAJECTORY_LINEAR 2,
        /// A coordinated arc.
        Circular = TRAJECTORY_CIRCULAR 3,
        /// A buffered command.
        Special = TRAJECTORY_SPECIAL 4,
        /// An exponential approach of one axis.
        Exponential = TRAJECTORY_EXPONENTIAL 5,
    }

    /// The kind of an axis' last independent motion: `CHAN.LastMotionType`.
    LastMotion {
        /// A jog.
        Jog = LAST_MOTION_JOG 0,
        /// A move of a single axis.
        Move = LAST_MOTION_MOVE 1,
        /// A rapid move of several axes.
        Multi = LAST_MOTION_MULTI 2,
        /// An exponential move.
        Exp = LAST_MOTION_EXP 3,
    }

    /// The quantity that the data recorder samples: `GATHER_VALUE_DEF.type`.
    GatherType {
        /// Nothing: the list ends here.
        End = GATHER_END_TYPE 0,
        /// A 32-bit integer.
        Int = GATHER_INT_TYPE 1,
        /// A word of `LastPWM`, less 1280.
        LastPwm = GATHER_LASTPWM_TYPE 2,
        /// A word of `LastPWM` in current mode, less 41984.
        LastPwmC = GATHER_LASTPWMC_TYPE 3,
        /// A float.
        Float = GATHER_FLOAT_TYPE 4,
        /// A double.
        Double = GATHER_DOUBLE_TYPE 5,
        /// An analog word: its upper 12 bits, less 2048.
        Adc = GATHER_ADC_TYPE 6,
        /// Nothing: zero is stored.
        Null = GATHER_NULL_TYPE 7,
    }
}

/// The outputs that go to zero when an axis is switched off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestOutputs {
    /// Nothing: steps stay where they are.
    Nothing,
    /// The word of its first channel.
    First,
    /// The words of both of its channels.
    Both,
    /// The words of its first channel and of the one after it.
    FirstAndNext,
    /// Its analog output.
    Analog,
}

/// The properties of an output mode for the servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutputTraits {
    /// True if nothing is compensated: the output follows the command.
    pub is_open_loop: bool,
    /// True if it drives a step generator, which other axes may name too.
    pub has_generator: bool,
    /// True if it corrects the commanded position by its output, and slaves follow both.
    pub corrects_command: bool,
    /// Enabling keeps the destination, as the position is not that of the motor.
    pub keeps_dest: bool,
    /// The outputs that go to zero when the axis is switched off.
    pub at_rest: RestOutputs,
    /// Cycles of the servo interrupt for an enabled axis, as measured.
    pub cycles: i64,
}

impl OutputTraits {
    /// A closed loop without a step generator.
    const LOOP: Self = Self {
        is_open_loop: false,
        has_generator: false,
        corrects_command: false,
        keeps_dest: false,
        at_rest: RestOutputs::Nothing,
        cycles: 0,
    };
}

impl OutputMode {
    /// The properties of the mode for the servo: one row a mode.
    #[must_use]
    pub const fn traits(self) -> OutputTraits {
        const LOOP: OutputTraits = OutputTraits::LOOP;
        match self {
            Self::None => OutputTraits { cycles: 290, ..LOOP },
            Self::Microstep => OutputTraits {
                is_open_loop: true,
                keeps_dest: true,
                at_rest: RestOutputs::Both,
                cycles: 282,
                ..LOOP
            },
            Self::DcServo => OutputTraits { at_rest: RestOutputs::First, cycles: 299, ..LOOP },
            Self::Brushless3Ph => OutputTraits { at_rest: RestOutputs::FirstAndNext, cycles: 429, ..LOOP },
            Self::Brushless4Ph => OutputTraits { at_rest: RestOutputs::Both, cycles: 467, ..LOOP },
            Self::DacServo => OutputTraits { at_rest: RestOutputs::Analog, cycles: 323, ..LOOP },
            Self::StepDir => OutputTraits { is_open_loop: true, has_generator: true, cycles: 225, ..LOOP },
            Self::ClosedLoopStepDir => {
                OutputTraits { has_generator: true, corrects_command: true, cycles: 429, ..LOOP }
            }
            Self::ClosedLoopMicrostep => {
                OutputTraits { corrects_command: true, at_rest: RestOutputs::Both, cycles: 489, ..LOOP }
            }
        }
    }

    /// Reports whether a number names a mode that drives a step generator.
    #[must_use]
    pub const fn has_generator(mode: Option<Self>) -> bool {
        matches!(mode, Some(mode) if mode.traits().has_generator)
    }

    /// Reports whether nothing is compensated in a mode; a number without a meaning compensates nothing either.
    #[must_use]
    pub const fn is_open_loop(mode: Option<Self>) -> bool {
        match mode {
            Some(mode) => mode.traits().is_open_loop,
            None => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::table;

    #[test]
    fn numbers_agree_with_the_specification() {
        let specified = table("constants.csv");
        for (name, value) in ALL {
            let row = specified.iter().find(|row| row["name"] == *name).expect(name);
            assert_eq!(row["value"], value.to_string(), "{name}");
        }
    }

    #[test]
    fn a_number_without_a_meaning_is_not_a_mode() {
        assert_eq!(InputMode::new(1), Some(InputMode::Encoder));
        assert_eq!(InputMode::new(5), None);
        assert_eq!(OutputMode::new(-1), None);
    }
}
