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
                /// The mode a number stands for.
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
    /// Where an axis' position comes from: `CHAN.InputMode`.
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

    /// What an axis drives: `CHAN.OutputMode`.
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

    /// How backlash is compensated: `CHAN.BacklashMode`.
    BacklashMode {
        /// Not at all.
        Off = BACKLASH_OFF 0,
        /// At a constant rate.
        Linear = BACKLASH_LINEAR 1,
    }

    /// What an entry of a profile or of the coordinated-motion buffer does: `trajectory_mode`.
    TrajectoryMode {
        /// It ends the list.
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

    /// What the data recorder samples: `GATHER_VALUE_DEF.type`.
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
    fn a_number_without_a_meaning_is_no_mode() {
        assert_eq!(InputMode::new(1), Some(InputMode::Encoder));
        assert_eq!(InputMode::new(5), None);
        assert_eq!(OutputMode::new(-1), None);
    }
}
