//! The table of script commands.
//!
//! Rows are in groups; their order has no meaning, because the longest matching word wins. Words, arguments and limits
//! are those of the released firmware (host-protocol.md section 3.2).

use kmotiondef::structs::Chan;

use super::Argument::{
    Assign, End, Equals, Hex, Integer, Limited, Numbered, OptionalEquals, OptionalHex, Real,
};
use super::data::GATHER_WORDS;
use super::{Argument, Command, axes, board, gather, io, motion, path, persist, programs, status};
use crate::servo::coordinated::download::Plane;

const THREAD: Argument = Integer(1, 7);
const AXIS: Argument = Numbered(0, 7, 15);
const BIT: Argument = Integer(0, 2047);
const SWITCH: Argument = Integer(0, 1);
/// The axis of a letter, or none.
const LETTER: Argument = Numbered(-1, 7, 15);
const ELEMENT: Argument = Integer(0, 199);
const WORD: Argument = Integer(0, GATHER_WORDS - 1);
const SAMPLES: Argument = Integer(1, 40_000);
/// Numbers of any plausible magnitude, with a sign and without.
const SIGNED: Argument = Limited(-1e12, 1e12);
const POSITIVE: Argument = Limited(0.0, 1e12);

/// A value of an axis that can be read and set.
const REAL: &[Argument] = &[AXIS, Assign, Real];
const SIGNED_REAL: &[Argument] = &[AXIS, Assign, SIGNED];
const POSITIVE_REAL: &[Argument] = &[AXIS, Assign, POSITIVE];
/// A target of an axis, and a target with another number.
const TARGET: &[Argument] = &[AXIS, Equals, Real];
const TARGET_AND: &[Argument] = &[AXIS, Equals, Real, Real];
const TARGET_AND_TWO: &[Argument] = &[AXIS, Equals, Real, Real, Real];

macro_rules! commands {
    ($(#[$doc:meta])+ $list:ident: $($name:literal $arguments:expr => $run:expr, $help:literal;)*) => {
        $(#[$doc])+
        pub const $list: &[Command] = &[
            $(Command { name: $name, arguments: $arguments, help: $help, run: $run }),*
        ];
    };
}

commands! {
    /// Commands that firmware 4.34 lacks, or takes with other limits.
    LATER_COMMANDS:
    "MoveAtVelAccel" TARGET_AND_TWO => motion::move_at_vel_accel, "moves an axis to a destination at a speed and an acceleration";
    "MoveRelAtVelAccel" TARGET_AND_TWO => motion::move_rel_at_vel_accel, "moves an axis by a distance at a speed and an acceleration";
    "JogAtAccel" TARGET_AND => motion::jog_at_accel, "moves an axis at a speed, reached with an acceleration; 0 stops it";
    "GetAllDestVelHex" &[] => motion::destinations_and_velocities, "reports destination and speed of all axes, in hexadecimal";
    "GetVirtualBits" &[Integer(0, 31), Integer(0, 32)] => io::get_virtual_bits, "reports words of extended virtual bits, in hexadecimal";
}

commands! {
    /// Commands that only a Kogna has. Source: the command table of its firmware and its manual; never compared.
    KOGNA_COMMANDS:
    "HRPWMSetMode" &[Integer(0, 3), Equals, SWITCH] => io::hrpwm_set_mode, "makes the pin of a fast PWM channel general, 1, or gives it to PWM, 0";
    "SPISetMode" &[Integer(0, 5), Equals, Integer(0, 2)] => io::spi_set_mode, "gives a pin to SPI, 0, or I2C, 2, or makes it general, 1";
}

commands! {
    /// Every script command of firmware 4.34.
    COMMANDS:
    // Programs.
    "Execute" &[THREAD] => programs::execute, "starts a thread at its entry point";
    "Kill" &[THREAD] => programs::kill, "stops a thread";
    "CheckThread" &[THREAD] => programs::check_thread, "reports whether a thread is active: 1 or 0";
    "EntryPoint" &[THREAD, Hex] => programs::entry_point, "sets the address where a thread starts";
    "SetStartupThread" &[THREAD, SWITCH] => programs::set_startup, "sets whether a thread starts at power-up";
    "LoadData" &[Hex, Hex] => programs::load_data, "stores bytes; lines of 64 follow; address and count in hexadecimal";
    "LoadFlash" &[Hex, Hex] => programs::load_flash, "accepts part of a firmware update and ignores it";
    "ClearFlashImage" &[] => board::clear_flash_image, "starts a firmware update, which is ignored";
    "ProgFlashImage" &[] => board::program_flash_image, "ends a firmware update, which is ignored";

    // The board.
    "Version" &[] => board::version, "reports the firmware's version";
    "Echo" &[] => board::echo, "sends its text back as a console line";
    "Flash" &[] => board::flash, "saves programs, persistent variables and axis settings in flash";
    "Reboot!" &[] => board::reboot, "restarts the board from flash";
    "USB" &[] => board::usb, "takes commands from USB";
    "RS232" &[Integer(9600, 115_200)] => board::rs232, "takes commands from the UART at a baud rate";
    "GetStatus" &[OptionalHex, OptionalHex] => status::get, "sends the status record; accepts HostStatus and EditChangeCount";

    // Persistent variables.
    "GetPersistDec" &[ELEMENT] => persist::get_decimal, "reports a persistent variable";
    "GetPersistHex" &[ELEMENT] => persist::get_hex, "reports a persistent variable in hexadecimal";
    "SetPersistDec" &[ELEMENT, Real] => persist::set_decimal, "sets a persistent variable";
    "SetPersistHex" &[ELEMENT, Hex] => persist::set_hex, "sets a persistent variable in hexadecimal";

    // The gather buffer.
    "GetGatherDec" &[WORD] => gather::get_decimal, "reports a word of the gather buffer";
    "SetGatherDec" &[WORD, Real] => gather::set_decimal, "sets a word of the gather buffer";
    "GetGatherHex" &[WORD, Integer(1, GATHER_WORDS)] => gather::get_hex, "sends words of the gather buffer, 8 on a line";
    "SetGatherHex" &[WORD, Integer(1, GATHER_WORDS)] => gather::set_hex, "takes words for the gather buffer; lines of 8 follow";
    "GatherMove" &[AXIS, Real, SAMPLES] => gather::gather_move, "records an axis while it moves away and back";
    "GatherStep" &[AXIS, Real, SAMPLES] => gather::gather_step, "records an axis while it jumps away and back";
    "GetGather" &[SAMPLES] => gather::get, "sends recorded samples: destination, position, output";
    "CheckDoneGather" &[] => gather::check_done, "reports whether recording is done: 1 or 0";
    "Inject" &[AXIS, Real, Real] => gather::inject, "disturbs an axis with noise below a frequency and records the response";
    "GetInject" &[] => gather::get_inject, "sends the recording of Inject";
    "ReadDiskData" &[Integer(0, 3), Integer(0, 1024)] => gather::read_disk_data, "answers a program that reads a file on the PC";

    // Enabling, position, profile.
    "EnableAxis" &[AXIS] => axes::enable, "enables an axis at its present position";
    "EnableAxisDest" &[AXIS, Real] => axes::enable_dest, "enables an axis at a destination";
    "DisableAxis" &[AXIS] => axes::disable, "disables an axis";
    "Zero" &[AXIS] => axes::zero, "makes the present position of an axis zero";
    "Enabled" &[AXIS, End] => axes::enabled, "reports whether an axis is enabled: 1 or 0";
    "Dest" REAL => |s, v| axes::double(s, v, Chan::DEST), "destination of an axis";
    "Pos" REAL => |s, v| axes::double(s, v, Chan::POSITION), "position of an axis";
    "Vel" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::VEL), "highest speed of moves, per second";
    "Accel" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::ACCEL), "highest acceleration, per second²";
    "Jerk" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::JERK), "highest jerk, per second³";

    // Servo settings.
    "P" SIGNED_REAL => |s, v| axes::single(s, v, Chan::P), "proportional gain";
    "I" SIGNED_REAL => |s, v| axes::single(s, v, Chan::I), "integral gain";
    "D" SIGNED_REAL => |s, v| axes::single(s, v, Chan::D), "derivative gain";
    "FFAccel" SIGNED_REAL => |s, v| axes::single(s, v, Chan::FF_ACCEL), "feed forward of acceleration";
    "FFVel" SIGNED_REAL => |s, v| axes::single(s, v, Chan::FF_VEL), "feed forward of speed";
    "MaxI" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::MAX_I), "limit of the integrator";
    "MaxErr" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::MAX_ERR), "limit of the error";
    "MaxOutput" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::MAX_OUTPUT), "limit of the output";
    "MaxFollowingError" REAL => |s, v| axes::double(s, v, Chan::MAX_FOLLOWING_ERROR), "following error that disables the axis";
    "DeadBandGain" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::DEAD_BAND_GAIN), "gain inside the dead band";
    "DeadBandRange" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::DEAD_BAND_RANGE), "half width of the dead band";
    "IIR" &[AXIS, Integer(0, 2), Assign, Real, Real, Real, Real, Real] => axes::filter, "coefficients A1 A2 B0 B1 B2 of a filter";

    // Inputs and outputs of an axis.
    "InputMode" &[AXIS, Assign, Integer(0, 4)] => |s, v| axes::integer(s, v, Chan::INPUT_MODE), "input that measures the position";
    "OutputMode" &[AXIS, Assign, Integer(0, 8)] => |s, v| axes::integer(s, v, Chan::OUTPUT_MODE), "output that the axis drives";
    "InputChan0" &[AXIS, Assign, Integer(0, 15)] => |s, v| axes::integer(s, v, Chan::INPUT_CHAN0), "first input channel";
    "InputChan1" &[AXIS, Assign, Integer(0, 15)] => |s, v| axes::integer(s, v, Chan::INPUT_CHAN1), "second input channel";
    "OutputChan0" &[AXIS, Assign, Numbered(0, 63, 255)] => |s, v| axes::integer(s, v, Chan::OUTPUT_CHAN0), "first output channel";
    "OutputChan1" &[AXIS, Assign, Integer(0, 15)] => |s, v| axes::integer(s, v, Chan::OUTPUT_CHAN1), "second output channel";
    "InputGain0" REAL => |s, v| axes::single(s, v, Chan::INPUT_GAIN0), "gain of the first input";
    "InputGain1" REAL => |s, v| axes::single(s, v, Chan::INPUT_GAIN1), "gain of the second input";
    "InputOffset0" REAL => |s, v| axes::single(s, v, Chan::INPUT_OFFSET0), "offset of the first input";
    "InputOffset1" REAL => |s, v| axes::single(s, v, Chan::INPUT_OFFSET1), "offset of the second input";
    "OutputGain" REAL => |s, v| axes::single(s, v, Chan::OUTPUT_GAIN), "gain of the output";
    "OutputOffset" REAL => |s, v| axes::single(s, v, Chan::OUTPUT_OFFSET), "offset of the output";
    "InvDistPerCycle" REAL => |s, v| axes::double(s, v, Chan::INV_DIST_PER_CYCLE), "motor cycles per unit of distance";
    "CommutationOffset" REAL => |s, v| axes::single(s, v, Chan::COMMUTATION_OFFSET), "offset of the commutation, in cycles";
    "StepperAmplitude" &[AXIS, Assign, Limited(0.0, 255.0)] => |s, v| axes::single(s, v, Chan::STEPPER_AMPLITUDE), "amplitude of a microstepped motor at rest";
    "Lead" &[AXIS, Assign, Limited(0.0, 10_000.0)] => |s, v| axes::single(s, v, Chan::LEAD), "lead compensation of a microstepped motor";
    "3PH" TARGET_AND => motion::three_phase, "energises a three-phase motor: amplitude, angle in cycles";
    "4PH" TARGET_AND => motion::four_phase, "energises a four-phase motor: amplitude, angle in cycles";

    // Limits, slaves, backlash.
    "LimitSwitch" &[AXIS, Assign, Hex] => |s, v| axes::word(s, v, Chan::LIMIT_SWITCH_OPTIONS), "options of the limit switches, in hexadecimal";
    "LimitSwitchNegBit" &[AXIS, Assign, BIT] => |s, v| axes::integer(s, v, Chan::LIMIT_SWITCH_NEG_BIT), "bit of the negative limit switch";
    "LimitSwitchPosBit" &[AXIS, Assign, BIT] => |s, v| axes::integer(s, v, Chan::LIMIT_SWITCH_POS_BIT), "bit of the positive limit switch";
    "SoftLimitNeg" REAL => |s, v| axes::single(s, v, Chan::SOFT_LIMIT_NEG), "lowest destination";
    "SoftLimitPos" REAL => |s, v| axes::single(s, v, Chan::SOFT_LIMIT_POS), "highest destination";
    "MasterAxis" &[AXIS, Assign, LETTER] => |s, v| axes::integer(s, v, Chan::MASTER_AXIS), "axis that this one follows, or -1";
    "SlaveGain" REAL => |s, v| axes::double(s, v, Chan::SLAVE_GAIN), "distance moved per unit of the master axis";
    "BacklashMode" &[AXIS, Assign, Integer(0, 4)] => |s, v| axes::integer(s, v, Chan::BACKLASH_MODE), "backlash compensation: 0 off, 1 linear";
    "BacklashAmount" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::BACKLASH_AMOUNT), "backlash to compensate";
    "BacklashRate" POSITIVE_REAL => |s, v| axes::single(s, v, Chan::BACKLASH_RATE), "speed of backlash compensation";

    // Independent motion.
    "Move" TARGET => motion::move_to, "moves an axis to a destination";
    "MoveRel" TARGET => motion::move_rel, "moves an axis by a distance";
    "MoveAtVel" TARGET_AND => motion::move_at_vel, "moves an axis to a destination at a speed";
    "MoveRelAtVel" TARGET_AND => motion::move_rel_at_vel, "moves an axis by a distance at a speed";
    "MoveExp" TARGET_AND => motion::move_exp, "approaches a destination exponentially with a time constant";
    "MoveXYZABC" &[Real; 6] => motion::move_xyzabc, "moves six axes of the coordinate system at once";
    "Jog" TARGET => motion::jog, "moves an axis at a speed; 0 stops it";
    "CheckDone" &[AXIS] => motion::check_done, "reports whether an axis is done: 1, 0, or -1 if disabled";
    "CheckDoneXYZABC" &[] => motion::check_done_xyzabc, "reports whether all axes of the coordinate system are done";

    // Coordinated motion.
    "DefineCS" &[Assign, LETTER, LETTER, LETTER, LETTER, LETTER, LETTER] => path::define_cs, "axes of the letters X Y Z A B C, -1 for none";
    "DefineCSEX" &[Assign, LETTER, LETTER, LETTER, LETTER, LETTER, LETTER, LETTER, LETTER] => path::define_cs_ex, "axes of the letters X Y Z A B C U V";
    "OpenBuf" &[] => path::open, "empties the buffer of coordinated motion";
    "ExecBuf" &[] => path::execute, "executes the buffer";
    "FlushBuf" &[] => path::flush, "marks the buffer as complete";
    "ExecTime" &[] => path::executed_time, "reports how much of the buffer has been executed, as a time; negative when done";
    "CheckDoneBuf" &[] => path::check_done, "reports whether the buffer is done: 1, 0, or -1 if an axis is disabled";
    "Linear" &[Real; 17] => |s, v| path::linear(s, v, 6), "adds a line: begin, end, a b c d, time";
    "LinearEx" &[Real; 21] => |s, v| path::linear(s, v, 8), "adds a line of eight letters";
    "LinearHex" &[Hex; 17] => |s, v| path::linear_hex(s, v, 6), "adds a line, in hexadecimal singles";
    "LinearHexEx" &[Hex; 21] => |s, v| path::linear_hex(s, v, 8), "adds a line of eight letters, in hexadecimal singles";
    "LHex1" &[Hex; 11] => |s, v| path::linear_on(s, v, 6), "continues from the last line: end, a b c d, time";
    "LHexEx1" &[Hex; 13] => |s, v| path::linear_on(s, v, 8), "continues from the last line, with eight letters";
    "LHex2" &[Hex; 5] => path::linear_again, "repeats the last line with a new a b c d, time";
    "Arc" &[Real; 19] => |s, v| path::arc(s, v, Plane::Xy), "adds an arc: centre, radii, angles, other letters, a b c d, time";
    "ArcXZ" &[Real; 19] => |s, v| path::arc(s, v, Plane::Zx), "adds an arc in the XZ plane";
    "ArcYZ" &[Real; 19] => |s, v| path::arc(s, v, Plane::Yz), "adds an arc in the YZ plane";
    "ArcHex" &[Hex; 19] => |s, v| path::arc(s, v, Plane::Xy), "adds an arc, in hexadecimal singles";
    "ArcHexZX" &[Hex; 19] => |s, v| path::arc(s, v, Plane::Zx), "adds an arc in the XZ plane, in hexadecimal singles";
    "ArcHexYZ" &[Hex; 19] => |s, v| path::arc(s, v, Plane::Yz), "adds an arc in the YZ plane, in hexadecimal singles";
    "ArcHexEx" &[Hex; 23] => |s, v| path::arc(s, v, Plane::Xy), "adds an arc of eight letters, in hexadecimal singles";
    "ArcHexZXEx" &[Hex; 23] => |s, v| path::arc(s, v, Plane::Zx), "adds an arc of eight letters in the XZ plane";
    "ArcHexYZEx" &[Hex; 23] => |s, v| path::arc(s, v, Plane::Yz), "adds an arc of eight letters in the YZ plane";
    "SetBitBuf" &[BIT] => path::set_bit, "adds to the buffer: set a bit";
    "ClearBitBuf" &[BIT] => path::clear_bit, "adds to the buffer: clear a bit";
    "SetStateBitBuf" &[BIT, Equals, SWITCH] => path::set_state_bit, "adds to the buffer: drive a bit";
    "WaitBitBuf" &[BIT] => path::wait_bit, "adds to the buffer: wait until a bit is high";
    "WaitNotBitBuf" &[BIT] => path::wait_not_bit, "adds to the buffer: wait until a bit is low";
    "BegRapidBuf" &[] => path::begin_rapid, "adds to the buffer: rapid motion begins";
    "EndRapidBuf" &[] => path::end_rapid, "adds to the buffer: rapid motion ends";
    "SetFRO" &[Real] => path::set_fro, "sets the feed rate override";
    "SetRapidFRO" &[Real] => path::set_rapid_fro, "sets the override of rapid motion";
    "SetFROTemp" &[Real] => path::set_fro_temp, "sets the feed rate override temporarily";
    "SetFROwRate" &[Real, Real] => path::fro_with_rate, "stops firmware 4.34; use the function of this name in a program";
    "SetRapidFROwRate" &[Real, Real] => path::fro_with_rate, "stops firmware 4.34; use the function of this name in a program";
    "SetFROwRateTemp" &[Real, Real] => path::fro_with_rate, "stops firmware 4.34; use the function of this name in a program";
    "StopImmediate" &[Integer(0, 2)] => path::stop_immediate, "feedhold: 0 stops, 1 resumes, 2 clears";
    "GetStopState" &[] => path::stop_state, "reports the state of the feedhold; 0 when running";
    "ConfigSpindle" &[SWITCH, AXIS, Real, Real, Real] => path::configure_spindle, "sets up the measurement of a spindle";
    "TrigThread" &[Real] => path::trigger_threading, "starts threading at a base speed";
    "GetSpindleRPS" &[] => path::spindle_speed, "reports the speed of the spindle in revolutions per second";

    // Inputs and outputs.
    "SetBit" &[BIT] => io::set_bit, "sets an output bit";
    "ClearBit" &[BIT] => io::clear_bit, "clears an output bit";
    "SetStateBit" &[BIT, Equals, SWITCH] => io::set_state_bit, "drives an output bit";
    "ReadBit" &[BIT] => io::read_bit, "reports the level of a bit";
    "SetBitDirection" &[Numbered(0, 167, 289), OptionalEquals, SWITCH] => io::set_bit_direction, "makes a bit an input, 0, or an output, 1";
    "GetBitDirection" &[Numbered(0, 167, 289)] => io::get_bit_direction, "reports whether a bit is an output";
    "GetVirtualBits" &[Integer(0, 31), Integer(0, 31)] => io::get_virtual_bits, "reports words of extended virtual bits, in hexadecimal";
    "LED" &[SWITCH, Equals, SWITCH] => io::led, "turns an LED on or off";
    "ADC" &[Numbered(0, 7, 11)] => io::adc, "reports an analog input, -2048 to 2047";
    "DAC" &[Numbered(0, 7, 15), Equals, Integer(-2048, 2047)] => io::dac, "sets an analog output";
    "PWM" &[Integer(0, 15), Equals, Integer(-255, 255)] => io::pwm, "sets a PWM output, locked anti-phase";
    "PWMR" &[Integer(0, 15), Equals, Integer(-511, 511)] => io::pwmr, "sets a PWM output, recirculating";
    "PWMC" &[Integer(8, 15), Equals, Integer(-1000, 1000)] => io::pwmc, "sets a PWM output, current mode";
    "FPGA" &[Integer(0, 1024), Integer(0, 255)] => io::fpga, "writes a register of 8 bits";
    "FPGAW" &[Integer(0, 1024), Integer(0, 65_535)] => io::fpgaw, "writes a register of 16 bits";
}
