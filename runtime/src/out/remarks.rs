//! Remarks of the simulated board: one row each.
//!
//! A row has a code, how much it matters, of what it is made once, and its text with named arguments. Whoever notices
//! something makes a [`Message`] with the arguments and hands it to `Out`; whether it is new, and whether anybody wants
//! it, is decided there and nowhere else.

mod key;
mod remark;

use std::fmt;

use kmotiondef::firmware::Function;
use kmotiondef::{AxisId, Bit, GuestAddr, ThreadId};

use key::Key;
pub use remark::{OtherPlace, Remark, Severity, Speaker};

/// Of what a remark is made once: of nothing, of the whole run, or of each value of an argument.
macro_rules! once {
    (always) => {
        None
    };
    (once) => {
        Some(0)
    };
    (per $field:ident) => {
        Some(Key::key($field))
    };
}

macro_rules! messages {
    ($(
        $(#[doc = $doc:literal])+
        $name:ident { $($field:ident: $ty:ty),* } = $code:literal, $severity:ident, [$($once:tt)+], $text:literal;
    )*) => {
        /// The message of a remark.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Message {
            $(
                $(#[doc = $doc])+
                $name {
                    $(#[doc = concat!("Stands for `{", stringify!($field), "}` in the text.")] $field: $ty,)*
                },
            )*
        }

        /// One row of the table, without its arguments.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct RemarkRow {
            /// Its code, as `-R no-CODE` and JSON have it.
            pub code: &'static str,
            /// The severity.
            pub severity: Severity,
            /// The text, with the names of its arguments in braces.
            pub text: &'static str,
            /// A description in a sentence.
            pub about: &'static str,
        }

        /// All rows.
        pub const REMARKS: &[RemarkRow] = &[$(
            RemarkRow {
                code: $code,
                severity: Severity::$severity,
                text: $text,
                about: concat!($($doc),+),
            },
        )*];

        impl Message {
            /// The code of its row.
            #[must_use]
            pub const fn code(&self) -> &'static str {
                match self {
                    $(Self::$name { .. } => $code,)*
                }
            }

            /// Returns the severity.
            #[must_use]
            pub const fn severity(&self) -> Severity {
                match self {
                    $(Self::$name { .. } => Severity::$severity,)*
                }
            }

            /// Of what it is made once: two remarks of a code and the same number are one.
            pub(super) fn once(&self) -> Option<u64> {
                match self {
                    $(
                        Self::$name { $($field),* } => {
                            // Most rows are not told apart by their arguments.
                            let _: &[&dyn fmt::Debug] = &[$($field),*];
                            once!($($once)+)
                        }
                    )*
                }
            }

            /// Its arguments, by name.
            #[must_use]
            pub fn arguments(&self) -> Vec<(&'static str, String)> {
                match self {
                    $(Self::$name { $($field),* } => vec![$((stringify!($field), $field.to_string())),*],)*
                }
            }
        }

        impl fmt::Display for Message {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                match self {
                    $(Self::$name { $($field),* } => write!(formatter, $text),)*
                }
            }
        }
    };
}

/// The words between a loss and its instant.
pub(crate) const LOST_AT: &str = " at ";

impl Message {
    /// Reports whether it says that an update was lost or that half of what was read was old, rather than that this can
    /// happen.
    #[must_use]
    pub fn is_loss(&self) -> bool {
        match self {
            Self::RaceUpdate { effect, .. }
            | Self::RaceStore { effect, .. }
            | Self::RaceCallBack { effect, .. }
            | Self::RaceRecord { effect, .. } => effect.contains(LOST_AT),
            _ => false,
        }
    }

    /// The second place of a remark about two.
    #[must_use]
    pub const fn other(&self) -> Option<OtherPlace> {
        match self {
            Self::RaceUpdate { other, .. }
            | Self::RaceStore { other, .. }
            | Self::RaceCallBack { other, .. }
            | Self::RaceClaim { other, .. }
            | Self::RaceTorn { other, .. }
            | Self::RaceTornStore { other, .. }
            | Self::RaceRecord { other, .. }
            | Self::ReadEarly { other, .. }
            | Self::PauseOvertaken { other, .. }
            | Self::RaceShared { other, .. }
            | Self::RaceRequest { other, .. }
            | Self::RaceRelays { other }
            | Self::OrderEarly { other, .. }
            | Self::MoveCut { other, .. }
            | Self::ZeroShifted { other, .. }
            | Self::LockOrder { other, .. } => Some(*other),
            _ => None,
        }
    }
}

messages! {
    /// Two threads change a cell by a load and a store, so that one can wipe out what the other has stored.
    RaceUpdate { other: OtherPlace, cell: String, effect: String } = "race-update", Warning, [always],
        "and {other} both change {cell} by a load and a store: {effect}. Hold the same lock at both places (MutexLock, MutexUnlock), or change bits with AtomicSet and AtomicClear";
    /// A thread changes a cell by a load and a store, and its call-back changes it too.
    RaceCallBack { other: OtherPlace, cell: String, effect: String } = "race-call-back", Warning, [always],
        "changes {cell} by a load and a store, and {other} changes it too, which can come in between: {effect}. Let only one of them change it (two cells, of which each changes one), or change bits with AtomicSet and AtomicClear; a call-back must not wait for a lock";
    /// A schedule switches threads before an access.
    Switched { does: &'static str, cell: String } = "switched", Warning, [always],
        "another thread runs {does} {cell}: a switch of the schedule";
    /// A program whose accesses cannot be watched is loaded.
    NotWatched { thread: ThreadId } = "not-watched", Warning, [per thread],
        "the program in thread {thread} is code for the controller's processor, whose accesses `--races` does not see: compile its source without `--engine dsp`, `--timing cc67` and `--target c67x`";
    /// A thread stores to a cell that another changes by a load and a store.
    RaceStore { other: OtherPlace, cell: String, effect: String } = "race-store", Warning, [always],
        "stores to {cell}, which {other} changes by a load and a store: {effect}. Hold the same lock at both places (MutexLock, MutexUnlock)";
    /// Two threads test the same cell and take it if it is free.
    RaceClaim { other: OtherPlace, cell: String } = "race-claim", Warning, [always],
        "and {other} both test whether {cell} is free and then set it: both can find it free. Take it with TestAndSet or MutexLock";
    /// A thread loads a value of eight bytes while another stores it.
    RaceTorn { other: OtherPlace, cell: String } = "race-torn", Warning, [always],
        "loads the eight bytes of {cell}, which {other} stores as two words: half of the value can be old. Hold the same lock at both places, or set a flag after the value and read the flag first";
    /// A thread stores a value of eight bytes while another loads it.
    RaceTornStore { other: OtherPlace, cell: String } = "race-torn-store", Warning, [always],
        "stores the eight bytes of {cell} as two words, and {other} loads them: half of the value can be old. Hold the same lock at both places, or set a flag after the value and read the flag first";
    /// A thread reads values that belong together while another changes them.
    RaceRecord { other: OtherPlace, cell: String, effect: String } = "race-record", Warning, [always],
        "reads {cell} together with other cells, which {other} changes: {effect}. Hold the same lock while all of them are stored and while all are read, or set a flag after the last store and read the flag first";
    /// A thread reads a cell before another stores its first value there.
    ReadEarly { other: OtherPlace, cell: String } = "read-early", Warning, [always],
        "reads {cell} once, before {other} stores its first value there, and nothing makes it wait for that. Set a flag after the store and wait for the flag before the read, or start the thread after the store";
    /// A thread tests a cell and pauses itself, and the one that stores the cell and resumes it can come in between.
    PauseOvertaken { other: OtherPlace, cell: String } = "pause-overtaken", Warning, [always],
        "tests {cell} and then pauses itself, but {other} can store it and call ResumeThread in between, which then has no effect: the thread stays paused. Wait in a loop on the cell with WaitNextTimeSlice()";
    /// Two threads use something that the board has once.
    RaceShared { other: OtherPlace, what: &'static str } = "race-shared", Warning, [always],
        "and {other} both use {what}, of which the board has one, and nothing makes one wait for the other: the second call takes it from the first. Hold the same lock from the first call until it is done";
    /// Two threads send requests to the PC without an order between them.
    RaceRequest { other: OtherPlace, cell: String } = "race-request", Warning, [always],
        "and {other} both send requests to the PC through {cell}: the second overwrites the first, and both threads see the answer of one. Hold the same lock from the request to its answer";
    /// Two threads switch outputs of Kanalog that lie in the same word.
    RaceRelays { other: OtherPlace } = "race-relays", Warning, [always],
        "and {other} both switch outputs of one group of 16 on Kanalog (bits 144-159, 160-167), which the firmware does by a load and a store: one can undo the other. Hold the same lock at both places";
    /// An order is posted before the parameter that belongs to it.
    OrderEarly { cell: String, order: String, other: OtherPlace } = "order-early", Warning, [always],
        "stores {cell} after the order in {order} is posted (by {other}): the order can be executed with the old value. Store the parameter first, the order last";
    /// Two threads take the same locks in opposite orders.
    LockOrder { other: OtherPlace, lock: String, held: String } = "lock-order", Warning, [always],
        "takes the lock {lock} while it holds {held}, and {other} takes them in the opposite order: both can wait forever. Take locks in the same order everywhere";
    /// A thread has ended with a lock.
    LockKept { lock: String } = "lock-kept", Warning, [always],
        "took the lock `{lock}` and has ended without MutexUnlock: the next thread that needs it waits forever";
    /// A call starts a thread that is active.
    ThreadRestarted { thread: ThreadId } = "thread-restarted", Warning, [per thread],
        "StartThread({thread}): thread {thread} is active, so it begins again, and what it had half done stays half done";
    /// A call names a bit that does not exist.
    NoSuchBit { function: Function, bit: i32 } = "no-such-bit", Warning, [always],
        "{function}({bit}): no such bit (0-2047)";
    /// A call names an axis that does not exist.
    NoSuchAxis { function: Function, axis: i32 } = "no-such-axis", Warning, [always],
        "{function}({axis}, …): no such axis (0-7)";
    /// A program reads an input that nothing drives: no switch, no device, no stimulus.
    UndrivenInput { bit: Bit, level: u8 } = "undriven-input", Hint, [per bit],
        "reads bit {bit}, an input that nothing drives; it stays {level}";
    /// A program reads an analog input that nothing drives: no machine, no device, no stimulus.
    UndrivenAdc { channel: i32, level: i32 } = "undriven-adc", Hint, [per channel],
        "ReadADC({channel}): nothing drives analog input {channel}; it stays {level}";
    /// A program writes to a bit of an option board that is always an input.
    InputWritten { function: Function, bit: Bit } = "input-written", Warning, [per bit],
        "{function}({bit}): bit {bit} is an input, so nothing changes";
    /// A program writes to a pin that is still an input.
    StillAnInput { function: Function, bit: Bit } = "still-an-input", Warning, [per bit],
        "{function}({bit}): bit {bit} is an input, so its pin does not change: call SetBitDirection({bit}, 1) first";
    /// A program uses a bit number to which nothing on the board or its option boards is connected.
    BitUnused { function: Function, bit: Bit } = "bit-unused", Warning, [per bit],
        "{function}({bit}): nothing is connected to bit {bit}: it reads 0 and cannot be written";
    /// A stimulus takes an input from the switch that drives it.
    SwitchOverridden { bit: Bit, axis: AxisId, span: String } = "switch-overridden", Hint, [per bit],
        "the stimulus overrides the switch of axis {axis} on bit {bit}{span}";
    /// A stimulus takes an analog input from the source of the machine file.
    SourceOverridden { channel: usize } = "source-overridden", Hint, [per channel],
        "the stimulus overrides `[[adc]]` of the machine file on analog input {channel} from now on";
    /// An encoder is turned from outside, and by the load that the machine file connects to the same input.
    EncoderTurnedTwice { input: usize, axis: AxisId } = "encoder-turned-twice", Warning, [per input],
        "encoder {input} is turned by hand, and by the load of axis {axis} as well, which the machine file connects to the same input: give the hand wheel an input of its own, or set `encoder = false` in `[axis.{axis}]`";
    /// An encoder is turned from outside, but no axis reads its input.
    EncoderUnread { input: usize } = "encoder-unread", Warning, [per input],
        "encoder {input} has been turned, but no axis reads its input, so nothing counts it: set InputMode = ENCODER_MODE and InputChan0 = {input} of an axis";
    /// A program makes a pin an output although a switch, a probe or a wire drives it.
    OutputAgainstInput { bit: Bit } = "output-against-input", Warning, [per bit],
        "SetBitDirection({bit}, 1): the machine drives bit {bit}, so two outputs drive the same pin, and the program can no longer read the input";
    /// A program reads an input of a KStep board without setting `KStepPresent`.
    KstepAbsent { bit: Bit } = "kstep-absent", Warning, [once],
        "ReadBit({bit}): inputs of a KStep read 0 until KStepPresent is set: write KStepPresent = TRUE first";
    /// A program reads a pin that a step generator uses for its pulses.
    StepPinRead { bit: Bit } = "step-pin-read", Warning, [per bit],
        "ReadBit({bit}): bit {bit} is a step or direction output, not an input: check OutputChan0 of the axes";
    /// The step output of an axis uses a pin that something outside the board drives.
    StepPins { axis: AxisId, bit: Bit, channel: i32 } = "step-pins", Warning, [per bit],
        "axis {axis} steps on OutputChan0 = {channel}, which uses bit {bit}, an input driven by the machine: set OutputChan0 to a free generator";
    /// A thread waits for a switch while its axis moves away from it.
    MovesAway { axis: AxisId, bit: Bit, place: String, load: f64 } = "moves-away", Warning, [per bit],
        "waits for bit {bit}, but axis {axis} moves away from its switch, which is active {place}: the axis is at {load:.0}";
    /// A call moves an axis that has no output although other axes have one.
    NoOutput { function: Function, axis: AxisId } = "no-output", Hint, [per axis],
        "{function}: axis {axis} has no OutputMode, so its Dest changes but no motor moves (should an init program run first?)";
    /// An axis moves, but the axis that should follow it is disabled.
    SlaveDisabled { axis: AxisId, master: AxisId } = "slave-disabled", Warning, [per axis],
        "axis {axis} has MasterAxis = {master}, but is disabled, so it does not follow: call EnableAxis({axis})";
    /// A move replaces an earlier move of the same axis that has not started yet.
    MoveReplaced { function: Function, axis: AxisId, earlier: f64, effect: String } = "move-replaced", Warning, [per axis],
        "{function}: the move of axis {axis} to {earlier} is {effect} before it starts: wait with `while (!CheckDone({axis}));` in between";
    /// A thread moves an axis by a distance right after another move, so the distances do not add up.
    RelativeReplaced { function: Function, axis: AxisId, earlier: f64, way: f64, dest: f64, target: f64 } = "relative-replaced", Warning, [per axis],
        "{function}: axis {axis} has only come to {dest} on its way to {earlier}, and {way} more from there is {target}: the distances do not add up. Wait with `while (!CheckDone({axis}));` in between";
    /// A thread begins a jog of an axis and right after it another motion.
    JogReplaced { function: Function, axis: AxisId, speed: f64, effect: &'static str } = "jog-replaced", Warning, [per axis],
        "{function}: the jog of axis {axis} at {speed} units/s is {effect} before it starts: wait in between, for a switch, a place or a time";
    /// A thread disables an axis after a delay that is too short for its move.
    MoveEnded { function: Function, axis: AxisId, dest: f64, earlier: f64 } = "move-ended", Warning, [per axis],
        "{function}: axis {axis} is at {dest:.0} on its way to {earlier}, and its motion ends here at once: wait with `while (!CheckDone({axis}));` first";
    /// An axis was disabled on its way, and enabled as if it were at another place.
    ZeroShifted { function: Function, axis: AxisId, from: f64, to: f64, shift: f64, other: OtherPlace } = "zero-shifted", Warning, [per axis],
        "{function}: axis {axis} was disabled on its way, at {from:.0}, and enabled with Dest = {to:.0} by {other}: its zero has shifted by {shift:.0}, and so has every target since. Enable it with EnableAxisDest({axis}, ch{axis}->Dest), or home it again";
    /// A path starts while one of its axes is disabled.
    PathDisabled { } = "path-disabled", Warning, [once],
        "a path is started, but an axis of the coordinate system is disabled, so nothing moves: enable all axes named in DefineCoordSystem";
    /// A path that is smoothed with a time constant of zero ends.
    KlpWithoutTau { } = "klp-without-tau", Warning, [once],
        "a path ended with KLP set and TauKLP 0, so Dest of its axes is now NaN: set TauKLP = -TIMEBASE / log(KLP) before the path starts";
    /// Two axes drive the same output.
    ChannelShared { function: Function, axis: AxisId, other: AxisId, channel: String } = "channel-shared", Warning, [per axis],
        "{function}: axis {axis} drives {channel}, which axis {other} drives too: give each axis an OutputChan0 of its own";
    /// Two axes close their loops over the same encoder.
    InputShared { function: Function, axis: AxisId, other: AxisId, input: i32 } = "input-shared", Warning, [per axis],
        "{function}: axis {axis} reads encoder input {input}, which axis {other} reads too: give each axis an InputChan0 of its own";
    /// An axis reads another encoder than the one of its motor.
    WrongInput { function: Function, axis: AxisId, input: i32, wired: usize } = "wrong-input", Warning, [per axis],
        "{function}: axis {axis} reads encoder input {input} (InputChan0), but the encoder of its motor is on input {wired}";
    /// An axis drives another output than the one that its motor is connected to.
    WrongOutput { function: Function, axis: AxisId, channel: String, wired: String } = "wrong-output", Warning, [per axis],
        "{function}: axis {axis} drives {channel} (OutputMode, OutputChan0), but its motor is connected to {wired}";
    /// An axis drives a PWM channel without an amplifier.
    NoAmplifier { function: Function, axis: AxisId, channel: usize } = "no-amplifier", Warning, [per axis],
        "{function}: axis {axis} drives PWM channel {channel}, where a KFLOP has no amplifier: a SnapAmp has channels 8 to 15, and an amplifier with an analog input needs DAC_SERVO_MODE";
    /// An axis is enabled at a place where it is not.
    Leap { function: Function, axis: AxisId, position: f64, dest: f64 } = "leap", Warning, [per axis],
        "{function}: axis {axis} is at {position:.0} and is enabled at {dest:.0}, so its motor leaps there: EnableAxis({axis}) begins where the axis is";
    /// A KStep gets the short pulses of power-up.
    KstepPulses { function: Function, axis: AxisId } = "kstep-pulses", Warning, [once],
        "{function}: axis {axis} steps on a KStep with the pulses of power-up, which are too short for it: write FPGA(STEP_PULSE_LENGTH_ADD) = 63 + 0x80 first";
    /// The soft limits of an axis that moves are swapped.
    SoftLimitsSwapped { function: Function, axis: AxisId, neg: f32, pos: f32 } = "soft-limits-swapped", Warning, [per axis],
        "{function}: SoftLimitNeg of axis {axis} is {neg} and SoftLimitPos {pos}: every place is beyond one of them";
    /// An axis is beyond a soft limit and should move further.
    BeyondSoftLimit { function: Function, axis: AxisId, dest: f64, name: &'static str, limit: f32 } = "beyond-soft-limit", Warning, [per axis],
        "{function}: axis {axis} is at {dest:.0}, beyond {name} = {limit}, so it does not move further";
    /// A setting of 0 keeps an axis from moving.
    NoGain { function: Function, axis: AxisId, field: &'static str, effect: &'static str } = "no-gain", Warning, [per axis],
        "{function}: axis {axis} has {field} = 0, so {effect}";
    /// An axis is to drive an output that no board has.
    NoSuchOutput { function: Function, axis: AxisId, channel: i32, kind: &'static str, most: usize } = "no-such-output", Warning, [per axis],
        "{function}: axis {axis} has OutputChan0 = {channel}: {kind} are numbered 0 to {most}";
    /// An axis is to read an encoder input that no board has.
    NoSuchInput { function: Function, axis: AxisId, input: i32 } = "no-such-input", Warning, [per axis],
        "{function}: axis {axis} has InputChan0 = {input}: encoder inputs are numbered 0 to 7, and 8 to 15 on SnapAmps";
    /// The mode or a channel of an axis was set after it was enabled.
    SetWhileEnabled { function: Function, axis: AxisId, field: &'static str } = "set-while-enabled", Warning, [per axis],
        "{function}: {field} of axis {axis} has changed since the axis was enabled: set it before EnableAxis, which prepares the output and takes over the position";
    /// The analog output of an axis can leave its range, beyond which it wraps.
    OutputWraps { function: Function, axis: AxisId, most: f64 } = "output-wraps", Warning, [per axis],
        "{function}: axis {axis} can output up to {most:.0} (MaxOutput, OutputGain, OutputOffset), but an analog output ends at 2047 and wraps to the other side: lower MaxOutput";
    /// A call moves a letter that has no axis.
    NoAxisForLetter { function: Function, letter: char, target: f64 } = "no-axis-for-letter", Warning, [once],
        "{function}: {letter} should go to {target}, but DefineCoordSystem has given it no axis";
    /// A call ends the motion of an axis that it does not wait for.
    MotionEnded { function: Function, axis: AxisId, how: String } = "motion-ended", Warning, [per axis],
        "{function}: axis {axis} {how}, and its motion ends here at once: wait with `while (!CheckDone({axis}));` first";
    /// A program writes an analog output that an enabled axis drives.
    DacOverwritten { axis: AxisId, dac: usize } = "dac-overwritten", Warning, [per axis],
        "a program writes DAC {dac}, which axis {axis} drives too: the axis overwrites it in each tick. Use another output, or disable the axis";
    /// A program writes a PWM output that an enabled axis drives.
    PwmOverwritten { function: Function, channel: i32, axis: AxisId } = "pwm-overwritten", Warning, [per axis],
        "{function}({channel}, …): axis {axis} drives this channel and overwrites it in each tick: disable the axis first";
    /// A thread asks for the end of a recording that was never started.
    NotRecording { } = "not-recording", Warning, [once],
        "CheckDoneGather is 1, because no recording was started after SetupGatherAllOnAxis: call TriggerGather()";
    /// A recording needs more than the gather buffer holds.
    RecordingTooLong { samples: i32, most: usize } = "recording-too-long", Warning, [once],
        "SetupGatherAllOnAxis: {samples} samples of 6 values do not fit in the gather buffer: it has room for {most}";
    /// A thread starts itself.
    StartsItself { thread: ThreadId } = "starts-itself", Warning, [per thread],
        "StartThread({thread}): the thread is running, so the call has no effect: use a loop to repeat a program";
    /// A file is opened for writing while another one is.
    FileReplaced { name: String, before: String } = "file-replaced", Warning, [always],
        "{name} is opened while {before} is open: the PC writes one file at a time, so all further lines go to {name}";
    /// A file is open for writing when all programs have ended.
    FileLeftOpen { name: String } = "file-left-open", Hint, [once],
        "{name} is still open for writing: call fclose, else the PC keeps the file open";
    /// An axis has a backlash, and its compensation is off.
    BacklashOff { function: Function, axis: AxisId, amount: f32 } = "backlash-off", Hint, [per axis],
        "{function}: axis {axis} has BacklashAmount = {amount}, but BacklashMode is BACKLASH_OFF, so nothing is taken up: set BACKLASH_LINEAR";
    /// An axis with a limit switch has been moved, and does not watch it at the end of the run.
    LimitsOff { axis: AxisId, end: &'static str, bit: Bit } = "limits-off", Hint, [per axis],
        "axis {axis} has LimitSwitch{end}Bit = {bit}, where its switch is, but LimitSwitchOptions does not watch it: the axis runs through it";
    /// The backlash of an axis is never taken up.
    NoBacklashRate { function: Function, axis: AxisId } = "no-backlash-rate", Warning, [per axis],
        "{function}: axis {axis} has BACKLASH_LINEAR with BacklashRate = 0, so its backlash is never taken up";
    /// Most of the time of a move of minutes is acceleration.
    SlowRamp { function: Function, axis: AxisId, seconds: f64, field: &'static str, value: f64 } = "slow-ramp", Warning, [per axis],
        "{function}: this move of axis {axis} takes {seconds:.0} s or more, because {field} is only {value}: units are counts and seconds";
    /// Two threads move the same axis.
    OtherThreadMoves { function: Function, axis: AxisId, other: ThreadId } = "other-thread-moves", Warning, [per axis],
        "{function}: axis {axis} is still moved by thread {other}, whose motion ends here";
    /// An axis was disabled while a thread waited for the end of its motion.
    DisabledWhileWaiting { axis: AxisId } = "disabled-while-waiting", Warning, [per axis],
        "CheckDone({axis}) is -1: axis {axis} was disabled before its motion ended, which `while (!CheckDone({axis}))` takes for its end";
    /// A thread waits for another axis than the one that it moves.
    WaitsForOther { asked: AxisId, moving: AxisId } = "waits-for-other", Warning, [per moving],
        "CheckDone({asked}) asks about axis {asked}, but the thread moves axis {moving}, for which it never waits";
    /// A thread waits for one of the axes that it moves and continues while another one, for which nobody ever waits, still moves.
    NotWaitedFor { function: Function, axis: AxisId, moving: AxisId } = "not-waited-for", Warning, [per moving],
        "{function}: axis {axis} begins to move while axis {moving} is still on its way, and no program ever waits for that one: wait with `while (!CheckDone({moving}));` too";
    /// A thread waits for one axis of its MoveXYZABC and switches an output while another one is still on its way.
    WaitsForPart { function: Function, switched: Bit, asked: AxisId, moving: AxisId } = "waits-for-part", Warning, [per moving],
        "{function}({switched}): axis {moving} is still on its way to the target of MoveXYZABC: `while (!CheckDone({asked}));` waits for axis {asked} alone, `while (!CheckDoneXYZABC());` for all";
    /// An index pulse has passed between two reads of its bit.
    IndexMissed { bit: Bit, axis: AxisId, width: f64, step: f64 } = "index-missed", Warning, [per bit],
        "ReadBit({bit}): an index pulse of axis {axis} has passed between two reads: it is {width} units wide, and the axis moves {step:.1} units from read to read";
    /// A thread pauses itself.
    PausesItself { thread: ThreadId } = "pauses-itself", Hint, [per thread],
        "PauseThread({thread}): the thread pauses itself, until another one calls ResumeThread({thread})";
    /// A running program is replaced by another one.
    ProgramReplaced { thread: ThreadId } = "program-replaced", Warning, [always],
        "the program of thread {thread} is still running and is replaced by another one: what it watched is not watched any more";
    /// A request to the PC is overwritten before the PC has seen it.
    RequestOverwritten { code: i32, by: i32 } = "request-overwritten", Warning, [once],
        "request {code} of another thread is overwritten with {by} before the PC has answered it: threads share persist.UserData[100], so use a mutex";
    /// A program has stored values after the end of the gather buffer.
    GatherOverrun { most: usize } = "gather-overrun", Warning, [once],
        "values are stored after the end of gather_buffer, which has {most} doubles: they overwrite other data of the board (noticed at this call)";
    /// The position of an enabled axis is written, and its motor leaps.
    PositionWritten { axis: AxisId, from: f64, to: f64 } = "position-written", Warning, [per axis],
        "Position of axis {axis} is changed from {from:.0} to {to:.0} while the axis is enabled, so its motor leaps: disable it first, or use Zero({axis}) (noticed at this call)";
    /// A loop with a sign that is right overshoots until its following error disables the axis.
    Overshoots { axis: AxisId, cause: &'static str } = "overshoots", Warning, [per axis],
        "axis {axis} overshoots until its following error disables it: {cause}";
    /// The output of a closed loop changes between its ends, so that the motor does not follow.
    Chatters { axis: AxisId, times: u32 } = "chatters", Warning, [per axis],
        "axis {axis} does not follow: its output has changed from end to end {times} times since it was enabled: lower D, or P";
    /// The position of a closed loop does not react, because its output has stayed too small.
    WeakOutput { axis: AxisId, output: f64, most: f32, p: f32 } = "weak-output", Warning, [per axis],
        "axis {axis} has not moved since it was enabled: its output has only come to {output:.1} of {most} (MaxOutput), which is too little to move its motor: raise P (now {p}) or FFVel";
    /// A SnapAmp has switched its bridges off, so the axis does not follow.
    BridgesOff { axis: AxisId, board: usize, cause: String } = "bridges-off", Warning, [per axis],
        "axis {axis} does not follow its Dest because SnapAmp {board} holds its bridges off: {cause}";
    /// The position moves farther than commanded, because its scale is wrong.
    ScaleWrong { axis: AxisId, ratio: f64, gain: f32, right: f64 } = "scale-wrong", Warning, [per axis],
        "axis {axis}: its Position moves {ratio:.2} times as far as its Dest: InputGain0 = {gain} does not fit the counts of the encoder, {right:.3} does";
    /// An axis does not move although its output drives it.
    NoResponse { axis: AxisId, output: f32 } = "no-response", Warning, [per axis],
        "axis {axis} has not moved since it was enabled, although its output is {output:.0}: check that OutputChan0 and InputChan0 name its amplifier and its encoder";
    /// An axis in a closed loop falls behind a destination that moves.
    Lags { axis: AxisId, most: f64 } = "lags", Warning, [per axis],
        "axis {axis} falls behind its Dest by more than MaxFollowingError = {most}, in the right direction: raise P or FFVel, or lower Vel or Accel, or allow more with MaxFollowingError";
    /// A program changes the destination of an enabled axis at once.
    DestLeaps { axis: AxisId, from: f64, to: f64 } = "dest-leaps", Warning, [per axis],
        "Dest of axis {axis} is changed from {from:.0} to {to:.0} at once, which no motor follows: use Move, which accelerates and decelerates (noticed at this call)";
    /// All moves of an axis are shorter than a few counts.
    TinyMove { function: Function, axis: AxisId, way: String } = "tiny-move", Hint, [per axis],
        "{function}: axis {axis} moves by {way} units, and never further: units are counts of an encoder or steps, so multiply a length by the counts of an inch or a millimetre";
    /// The target of a motion is beyond a soft limit.
    TargetBeyond { function: Function, axis: AxisId, target: f64, name: &'static str, limit: f32 } = "target-beyond-limit", Warning, [per axis],
        "{function}: {target:.0} is beyond {name} = {limit} of axis {axis}, so a feedhold stops the axis on its way, and all others of the coordinate system";
    /// A limit switch is taken for active although nothing presses it.
    LimitActive { function: Function, axis: AxisId, end: &'static str, bit: Bit, level: u8, polarity: u32 } = "limit-active", Warning, [per axis],
        "{function}: LimitSwitch{end}Bit of axis {axis} is {bit}, which is {level} and so counts as active, but nothing presses the switch: change bit {polarity} of LimitSwitchOptions";
    /// The numbers of limit switches are in fields that are not used.
    LimitFields { function: Function, axis: AxisId, end: &'static str, bit: i32, used: Bit } = "limit-fields", Warning, [per axis],
        "{function}: axis {axis} watches bit {used}, not LimitSwitch{end}Bit = {bit}, because bit 8 of LimitSwitchOptions is 0: add 0x100";
    /// An axis follows another one with a gain of zero.
    NoSlaveGain { axis: AxisId, master: AxisId } = "no-slave-gain", Warning, [per axis],
        "axis {axis} has MasterAxis = {master} and SlaveGain = 0, so it does not follow: set SlaveGain, mostly to 1";
    /// An axis that follows another one and that other one move at the same time by calls of their own.
    SlaveMoves { function: Function, axis: AxisId, master: AxisId } = "slave-moves", Warning, [per axis],
        "{function}: axis {axis} follows axis {master} (MasterAxis), but not while it executes a motion of its own: what axis {master} moves until then is lost to it; wait for the end of one motion before the other";
    /// A feedhold leaves an axis moving that is not in the coordinate system.
    StopLeaves { function: Function, axis: AxisId, target: f64 } = "stop-leaves", Hint, [per axis],
        "{function}: axis {axis} is not in the coordinate system, so it goes on to {target:.0}: name it in DefineCoordSystem, or stop it with Jog({axis}, 0)";
    /// A feed rate override is far more than the usual.
    OverrideFactor { function: Function, value: f32, percent: f64 } = "override-factor", Warning, [once],
        "{function}({value}): 1 is the programmed speed, so this is {percent:.0} %";
    /// A switch has changed long before a program reads it.
    ReadLate { bit: Bit, axis: AxisId, ms: f64, step: f64 } = "read-late", Hint, [per bit],
        "ReadBit({bit}): axis {axis} has moved {step:.0} units in the {ms:.0} ms since the read before, and its switch has changed in between: read more often, or move more slowly";
    /// A pulse at an input has come and gone between two reads of a program that polls it.
    PulseMissed { bit: Bit, width_ms: f64, gap_ms: f64 } = "pulse-missed", Hint, [per bit],
        "ReadBit({bit}): a pulse of {width_ms:.1} ms at this input has come and gone in the {gap_ms:.0} ms since the read before, and nobody saw it: read more often, or make the pulse longer";
    /// An input that a loop has watched has fallen while the loop waited for something else.
    SeenLate { bit: Bit, ms: f64 } = "seen-late", Hint, [per bit],
        "ReadBit({bit}): this input went off {ms:.0} ms ago, and the loop that read it all the time before was waiting for something else: what has to stop a machine at once needs a loop, or a thread, that does nothing else";
    /// A move begins while an earlier one, which the thread has given some time, is under way.
    MoveCut { function: Function, axis: AxisId, dest: f64, earlier: f64, target: f64, other: OtherPlace } = "move-cut", Warning, [per axis],
        "calls {function} for axis {axis}, which is at {dest:.0} on its way to {earlier:.0} (by {other}): it goes to {target:.0} from here and never arrives at {earlier:.0}. Wait for it with `while (!CheckDone({axis}));`";
    /// A number that a program uses is the bits of a floating-point number in `persist.UserData`.
    FloatBits { function: Function, what: String, index: usize, float: f32 } = "float-bits", Warning, [per index],
        "{function}: {what} the bits of the float {float}, which is in persist.UserData[{index}]: read it as *(float *)&persist.UserData[{index}]";
    /// A spindle is configured with other counts than its encoder has.
    SpindleCounts { counts: f32, real: f64, hint: &'static str } = "spindle-counts", Warning, [once],
        "ConfigureSpindle: {counts} counts per revolution, but the encoder of the spindle has {real}{hint}, so speeds and threads are wrong by that factor";
    /// A switch or probe of the machine file is beyond the end of the travel.
    SwitchUnreachable { bit: Bit, axis: AxisId, place: String, source: String, end: f64, key: String } = "switch-unreachable", Warning, [per bit],
        "the switch or probe on bit {bit} ({source}) is active {place}, but the travel of axis {axis} ends at {end} ({key}): it is never reached";
    /// A pulse of a stimulus is shorter than a tick.
    ShortPulse { bit: Bit, us: f64 } = "short-pulse", Hint, [per bit],
        "the pulse at bit {bit} takes {us:.0} µs, less than a tick of 90 µs: a program that reads the bit in each of its slices can miss it";
    /// An analog input of a stimulus has a few counts, where volts are probably meant.
    FewCounts { place: String, channel: usize, value: f64, volts: f64, wanted: String } = "few-counts", Warning, [always],
        "{place}adc {channel} = {value} is a number of counts, {volts:.3} V: write {wanted} for volts";
    /// The PC finds no text where a request says, but at the same number of bytes or of doubles.
    TextElsewhere { code: i32, offset: i32, unit: &'static str, words: i32 } = "text-elsewhere", Warning, [per code],
        "request {code}: no text is at word {offset} of the gather buffer, but there is one at {offset} {unit}: the offset counts words of 4 bytes, so store {words} in persist.UserData[101]";
    /// A request names the address of a text, where the PC takes an offset in the gather buffer.
    TextAddress { code: i32 } = "text-address", Warning, [per code],
        "request {code}: persist.UserData[101] is the address of a text, but the PC reads texts in the gather buffer alone: copy it there, and store its offset in words";
    /// A request to the PC is replaced by another one of the same thread before the PC has seen it.
    RequestReplaced { code: i32, by: i32 } = "request-replaced", Warning, [once],
        "request {code} is replaced by {by} before the PC has answered it, and is lost: wait until persist.UserData[100] is no longer positive (noticed at this call)";
    /// Two outputs that drive a motor in opposite directions are both on.
    BothDirections { function: Function, bit: Bit, other: Bit } = "both-directions", Warning, [per bit],
        "{function}({bit}): output {other} is on as well, so the motor is switched to both directions at once: clear one before the other is set";
    /// An axis drives the analog output that a spindle is connected to.
    SpindleShared { function: Function, axis: AxisId, dac: usize } = "spindle-shared", Warning, [per axis],
        "{function}: axis {axis} drives DAC {dac}, which the spindle is connected to: give the axis an OutputChan0 of its own";
    /// An axis drives a channel of a SnapAmp that the machine does not have.
    NoSnapAmp { function: Function, axis: AxisId, channel: usize } = "no-snapamp", Warning, [per axis],
        "{function}: axis {axis} drives PWM channel {channel}, which belongs to a SnapAmp, and the machine has none (`board.snapamp = 1` in the machine file)";
    /// An axis closes its loop over an analog input that nothing drives.
    NoFeedback { function: Function, axis: AxisId, channel: usize } = "no-feedback", Warning, [per axis],
        "{function}: axis {axis} closes its loop over analog input {channel}, which nothing drives: ENCODER_MODE reads the encoder of a motor";
    /// A limit switch of an axis is tripped by another one.
    LimitOfOther { function: Function, axis: AxisId, end: &'static str, bit: Bit, other: AxisId } = "limit-of-other", Warning, [per axis],
        "{function}: LimitSwitch{end}Bit of axis {axis} is {bit}, a switch of axis {other}";
    /// A thread zeroes another axis than the one that it has moved to its switch.
    ZeroesOther { axis: AxisId, homed: AxisId } = "zeroes-other", Warning, [per axis],
        "Zero({axis}): the thread has moved axis {homed} to its switch, but zeroes axis {axis}, which it never moves";
    /// The two sides of a gantry are too far apart.
    GantryRacks { axis: AxisId, other: AxisId, apart: f64, most: f64 } = "gantry-racks", Warning, [per axis],
        "the sides of a gantry, axes {axis} and {other}, are {apart:.1} units apart, and it bears {most}: move both together (MasterAxis of axis {other} = {axis}, SlaveGain = 1)";
    /// A load is moved against the end of its travel.
    HardStop { axis: AxisId, place: f64, key: String, effect: String } = "hard-stop", Warning, [per axis],
        "axis {axis} runs into the end of its travel at {place} ({key}): {effect}";
    /// The machine file gives a unit to an axis that a program moves in steps or counts, far too fast for its travel.
    UnitsDiffer { function: Function, axis: AxisId, units: String, place: String, speed: f64, unit: &'static str, travel: f64, field: &'static str } = "units-differ", Warning, [per axis],
        "{function}: axis {axis} can move at {speed} {unit} per second ({field} is 1), and its travel in the machine file is {travel} units: units = \"{units}\" ({place}) is only a name. Min, max, start and the places of switches are in the units of the program, here {unit}";
    /// An approach has a time constant of many seconds.
    LongTau { function: Function, axis: AxisId, tau: f64 } = "long-tau", Hint, [per axis],
        "{function}: axis {axis} approaches its target with a time constant of {tau} s, so it takes {tau} s for two thirds of the way: Tau is in seconds";
    /// Two threads print into the same line.
    LinesMixed { other: ThreadId } = "lines-mixed", Warning, [once],
        "prints into the line that thread {other} has begun: print each line with one call";
    /// The call-back of a thread is replaced by that of another.
    CallBackReplaced { thread: ThreadId, by: ThreadId } = "call-back-replaced", Warning, [once],
        "UserCallBack of thread {thread} is replaced by a function of thread {by}: the board has only one call-back, so that of thread {thread} is not called any more";
    /// A program has stored values after the end of `persist.UserData`.
    UserDataOverrun { index: u32 } = "user-data-overrun", Warning, [once],
        "a value is stored in persist.UserData[{index}], but valid indices are 0 to 199: other data of the board are overwritten (noticed at this call)";
    /// A path was aborted while a thread waited for its end.
    PathEndedWhileWaiting { } = "path-ended-while-waiting", Warning, [once],
        "CheckDoneXYZABC or CheckDoneBuf is -1: an axis was disabled before the path ended, which `while (!CheckDoneXYZABC())` takes for its end";
    /// A thread disables an axis of the path that it has started.
    PathEnded { function: Function, axis: AxisId } = "path-ended", Hint, [per axis],
        "{function}: axis {axis} follows a path, which ends here for all its axes";
    /// A thread waits for minutes.
    LongDelay { function: Function, seconds: f64 } = "long-delay", Hint, [once],
        "{function}({seconds}): the thread waits {seconds} seconds; write {function}(0.001 * ms) for milliseconds";
    /// Vel of an axis was changed during a move.
    SpeedChanged { axis: AxisId, from: f32, to: f32 } = "speed-changed", Hint, [per axis],
        "CheckDone({axis}): Vel of axis {axis} was changed from {from} to {to} during its move, which kept the Vel that it began with: a new Vel counts from the next move on";
    /// A motion has ended, but the axis is somewhere else.
    NotThere { axis: AxisId, position: f64, dest: f64, advice: String } = "not-there", Warning, [per axis],
        "CheckDone({axis}) is 1, but axis {axis} is at {position:.0} and its Dest is {dest:.0}: CheckDone looks only at Dest, which the motor does not follow ({advice})";
    /// A limit switch of an axis is at its other end.
    LimitAtOtherEnd { function: Function, axis: AxisId, end: &'static str, bit: Bit, place: String } = "limit-at-other-end", Warning, [per axis],
        "{function}: LimitSwitch{end}Bit of axis {axis} is {bit}, a switch that is active {place}, at the other end";
    /// A thread stops a jog after it has watched the switch of an axis that rests.
    WatchesOther { axis: AxisId, bit: Bit, other: AxisId } = "watches-other", Warning, [per axis],
        "Jog({axis}, 0): the thread has watched bit {bit} on the way, but that is a switch of axis {other}, which rests: watch the switch of axis {axis}";
    /// A jog is stopped before the axis has moved.
    JogEnded { axis: AxisId, to: f64, speed: f64, bit: Bit, switch: String } = "jog-ended", Hint, [per axis],
        "Jog({axis}, {to}): axis {axis} has not moved since Jog({axis}, {speed}): bit {bit} was already as the program waited for: {switch}";
    /// An axis cannot follow because its output is at its limit.
    OutputLimit { axis: AxisId, most: f32 } = "output-limit", Warning, [per axis],
        "axis {axis} cannot follow: its output is at MaxOutput = {most}; lower Vel or Accel, or raise MaxOutput";
    /// An axis in a closed loop goes the wrong way until its following error disables it.
    RunsAway { axis: AxisId } = "runs-away", Warning, [per axis],
        "axis {axis} runs away: its output drives it further from Dest; change the sign of OutputGain or of InputGain0";
    /// A call stores a text or a block in an array that is too small for it.
    BeyondArray { function: Function, name: String, size: u32, bytes: usize } = "beyond-array", Warning, [always],
        "{function} stores {bytes} bytes in `{name}`, which has {size}: the memory after it is overwritten";
    /// A value for a PWM output is out of range.
    PwmRange { function: Function, channel: i32, value: i32, most: i32 } = "pwm-range", Warning, [per channel],
        "{function}({channel}, {value}): the range is -{most} to {most}, and the value is limited to it";
    /// A call names a PWM output that does not exist.
    NoSuchPwm { function: Function, channel: i32 } = "no-such-pwm", Warning, [per channel],
        "{function}({channel}, …): no such channel (0-15)";
    /// A call prints more characters than the board takes from one.
    TextCut { function: Function, size: usize } = "text-cut", Warning, [once],
        "{function}: this text has {size} characters, and the board takes 128 of a call: the rest is lost, and the end of the line with it; print it with several calls";
    /// A line is longer than the board's lines.
    LongLine { size: usize } = "long-line", Hint, [once],
        "a line of the console has 125 characters at most, so this one of {size} arrives as two";
    /// A program ends with a line of text that has no newline.
    UnfinishedLine { text: String } = "unfinished-line", Hint, [once],
        "the text `{text}` has no newline: the board keeps it, and the PC never receives it";
    /// The operator of `--assist` toggles an input for 0.1 s.
    Assisted { bit: Bit, level: u8 } = "assisted", Warning, [always],
        "waits, so --assist sets bit {bit} to {level} for 0.1 s";
    /// A call passes an address that is not an element of `chan`.
    NotAnAxis { function: Function, chan: GuestAddr } = "not-an-axis", Warning, [always],
        "{function}: {chan} is not an axis structure";
    /// A call names a thread that does not exist.
    NoSuchThread { function: Function, thread: i32 } = "no-such-thread", Warning, [always],
        "{function}({thread}): no such thread (1-7)";
    /// A call starts a thread without a program.
    ThreadEmpty { thread: ThreadId } = "thread-empty", Warning, [always],
        "StartThread({thread}): no program is loaded in thread {thread}";
    /// A script command starts a thread without a program.
    ExecuteEmpty { thread: ThreadId } = "execute-empty", Warning, [always],
        "Execute{thread}: no program is loaded in thread {thread}, so nothing starts";
    /// A call names an analog input that does not exist.
    NoSuchAdc { channel: i32 } = "no-such-adc", Warning, [always],
        "ReadADC({channel}): no such channel (0-7)";
    /// A call names a register that a SnapAmp does not have.
    NoSuchSnapRegister { function: Function, address: i32 } = "no-such-snap-register", Warning, [always],
        "{function}({address:#x}): no such register (0x40-0x7f)";
    /// A motion call names an axis that is disabled.
    AxisDisabled { function: Function, axis: AxisId } = "axis-disabled", Warning, [always],
        "{function}: axis {axis} is disabled, so nothing moves";
    /// A motion call names an axis that follows a path.
    AxisOnPath { function: Function, axis: AxisId } = "axis-on-path", Warning, [always],
        "{function}: axis {axis} is executing coordinated motion, which continues; the axis moves by itself when that has ended";
    /// A call moves an axis that has switches but no output.
    AxisUndriven { function: Function, axis: AxisId } = "axis-undriven", Hint, [per axis],
        "{function}: axis {axis} drives nothing because its OutputMode is NO_OUTPUT_MODE, so the machine does not move (should an init program run first?)";
    /// A program calls motions faster than the board can plan them.
    Hurried { function: Function, axis: AxisId, ms: f64, calls: u8 } = "hurried", Hint, [always],
        "{function}: axis {axis} gets a new target within {ms} ms, {calls} times in a row. The board takes that long to plan a motion that replaces another, and the axis keeps its speed until then: no target ever takes effect. Call less often, or use MoveExp";
    /// A motion call passes a number that is not finite.
    NotAPlace { function: Function, value: f64, effect: &'static str } = "not-a-place", Warning, [always],
        "{function}: {value} is not a valid position or speed: {effect}";
    /// A move names a speed that is not positive.
    NoSpeed { function: Function, axis: AxisId, speed: f32 } = "no-speed", Warning, [per axis],
        "{function}: the speed {speed} of axis {axis} is not positive, so it does not move; the target decides the direction";
    /// A motion call names an axis without limits.
    NoLimits { function: Function, axis: AxisId } = "no-limits", Warning, [always],
        "{function}: Vel, Accel and Jerk of axis {axis} are not all positive";
    /// The list of states that an axis should execute does not exist.
    NoStates { axis: AxisId } = "no-states", Warning, [always],
        "axis {axis}: pcoeff does not point to a list of states; its motion has ended";
    /// A step generator is commanded to go faster than its pulses allow.
    StepsTooFast { axis: AxisId, fastest: f64, length: f64, slower: &'static str } = "steps-too-fast", Warning, [per axis],
        "axis {axis} needs more than {fastest:.0} steps per second, the most that pulses of {length:.2} µs allow: it falls behind and catches up later: {slower}, or shorten the pulses (STEP_PULSE_LENGTH_ADD)";
    /// A real brushless motor would not turn as the simulated one does.
    WouldNotTurn { axis: AxisId } = "would-not-turn", Warning, [always],
        "axis {axis}: with this CommutationOffset a real brushless motor would not turn as commanded; the simulated one follows (model \"follow\")";
    /// A coordinate system is defined with numbers that are not axes.
    BadCoordSystem { axes: String } = "bad-coord-system", Warning, [always],
        "DefineCoordSystem: {axes} must be axes 0 to 7 or -1; the board does not check them";
    /// A coordinate system is defined with the same axis for two letters.
    CoordSystemTwice { axes: String } = "coord-system-twice", Warning, [always],
        "DefineCoordSystem: {axes} names an axis twice";
    /// The path being executed is overwritten by a longer one.
    PathOverwritten { } = "path-overwritten", Warning, [always],
        "coordinated motion: the buffer is full and the segment being executed is overwritten";
    /// The pointer to the path does not point at segments.
    NoSegments { list: GuestAddr } = "no-segments", Warning, [always],
        "CoordSystem0 is {list}, where there are no segments; the path has ended";
    /// A spindle is configured with an axis that does not exist.
    NoSuchSpindleAxis { axis: i32 } = "no-such-spindle-axis", Warning, [always],
        "ConfigureSpindle: no such axis (0-7): {axis}";
    /// A spindle is configured without counts.
    NoSpindleCounts { counts: f32 } = "no-spindle-counts", Warning, [always],
        "ConfigureSpindle: {counts} is not a valid number of counts per revolution";
    /// Threading begins without a spindle.
    NoSpindle { } = "no-spindle", Warning, [always],
        "TrigThreading: no spindle is configured, so nothing will move";
    /// Threading begins with a base speed of zero.
    NoBaseSpeed { speed: f32 } = "no-base-speed", Warning, [always],
        "TrigThreading: {speed} revolutions/s is not a valid base speed";
    /// Threading begins without a path.
    NothingToThread { } = "nothing-to-thread", Warning, [always],
        "TrigThreading: the segment buffer is empty";
    /// A Konnect is added at an address that no board can have.
    KonnectAddress { function: Function, address: i32 } = "konnect-address", Warning, [always],
        "{function}({address}, …): boards have addresses 0 to 7";
    /// A Konnect is added that the machine does not have.
    KonnectAbsent { function: Function, address: i32 } = "konnect-absent", Warning, [always],
        "{function}({address}, …): the machine has no board with that address";
    /// A load overwrites the words of a Konnect service.
    KonnectDropped { thread: ThreadId } = "konnect-dropped", Warning, [always],
        "the Konnect service with words of thread {thread} ends: the program of the thread is replaced";
    /// A program writes an output of Kanalog, which is not switched on.
    KanalogOff { bit: Bit } = "kanalog-off", Detail, [once],
        "bit {bit} is an output of Kanalog, which is not switched on: the value is only stored (`board.kanalog = true` in the machine file)";
    /// A program makes a pin an output that the interface of Kanalog uses.
    KanalogPins { bit: Bit } = "kanalog-pins", Warning, [once],
        "bit {bit} becomes an output, but Kanalog is connected to bits 0 to 15 of JP7";
    /// A program writes an unknown register of the FPGA.
    UnknownRegister { number: u32 } = "unknown-register", Detail, [per number],
        "FPGA register {number:#x} is unknown: it only stores what is written";
    /// A program writes to a bus address to which nothing is connected.
    NoEffect { address: GuestAddr } = "no-effect", Warning, [always],
        "write to {address} has no effect";
    /// The UART sends without being connected to its pins.
    UartUnconnected { } = "uart-unconnected", Warning, [once],
        "the UART is not connected to its pins: call InitRS232, or write 2 to KAN_TRIG_REG";
    /// A program uses the serial port before its service is started.
    UartNotServed { function: Function } = "uart-not-served", Warning, [once],
        "{function}: nothing moves characters between the serial port and its buffers yet: call EnableRS232Cmds first";
    /// Characters received on the UART were not read in time.
    UartOverrun { size: usize } = "uart-overrun", Warning, [once],
        "{size} characters received on the UART were not read and are lost";
    /// Characters on the UART are taken as commands.
    UartCommands { } = "uart-commands", Warning, [once],
        "characters received on the UART are taken as script commands; clear DoRS232Cmds to read them";
    /// A line of a file is written in parts.
    LineInParts { } = "line-in-parts", Warning, [once],
        "fprintf: the line before is unfinished; as on the board, a stray character 2 precedes this text, and a line begun by printf goes to the console. Write each line with one call";
    /// A text printed to a file contains a percent sign, which is formatted a second time.
    PercentTwice { } = "percent-twice", Warning, [once],
        "fprintf: the text contains a %, which the board reads as a conversion again. Write %%%% for it";
    /// The PC refuses to write a file.
    FileNotMade { name: String, error: String } = "file-not-made", Warning, [always],
        "the PC cannot write {name}: {error}";
    /// The PC refuses to read a file.
    FileNotRead { name: String, error: String } = "file-not-read", Warning, [always],
        "the PC cannot read {name}: {error}";
    /// A file is opened while an answer about the last one is on its way.
    OldFileAnswer { name: String } = "old-file-answer", Warning, [always],
        "fopen {name}: an answer about the file before is still on its way, and the board takes it for the answer to this fopen: read that file to its end, or wait 0.1 s before the next fopen";
    /// The PC fails to write to an open file.
    FileNotWritten { name: String, error: String } = "file-not-written", Warning, [always],
        "the PC cannot write {name}: {error}";
    /// A line is written without an open file.
    NoOpenFile { } = "no-open-file", Warning, [once],
        "a line is written, but no file is open for writing on the PC";
    /// A program sends a request, but no PC is connected.
    NoPc { code: i32 } = "no-pc", Warning, [always],
        "request {code} waits for a PC, but none is connected (`host.enabled = false`)";
    /// Nobody reads the replies of the board.
    RepliesLost { bytes: usize } = "replies-lost", Warning, [always],
        "{bytes} bytes of replies have not been read; further replies are lost";
    /// A program frees a block that was never allocated.
    NotAllocated { block: GuestAddr } = "not-allocated", Warning, [always],
        "free({block}): no block of the heap starts there";
    /// A program writes flash outside the blocks of user flash.
    NotABlock { words: i32, to: GuestAddr } = "not-a-block", Warning, [always],
        "ProgramFlash: {words} words at {to}: blocks of user flash start at multiples of 0x10000 from 0x90100000 and hold 32768 words";
    /// A program has used more stack than the board has.
    StackUsed { used: u32 } = "stack-used", Warning, [always],
        "{used} bytes of stack used; the board has about 1900";
    /// A load overwrites a call-back.
    CallBackDropped { thread: ThreadId } = "call-back-dropped", Warning, [always],
        "the call-back in the space of thread {thread} is removed: the program of the thread is replaced";
    /// The flash holds no valid program for a thread.
    NotFlashed { thread: ThreadId, error: String } = "not-flashed", Warning, [always],
        "the flash holds no valid program for thread {thread}: {error}";
    /// A program of a stimulus cannot be run.
    NotRun { name: String, thread: ThreadId, error: String } = "not-run", Warning, [always],
        "{name} is not run in thread {thread}: {error}";
    /// A downloaded program cannot be started.
    NotStarted { thread: ThreadId, error: String } = "not-started", Warning, [always],
        "thread {thread} is not started: {error}";
    /// A stimulus starts a thread without a program.
    StimulusThreadEmpty { place: String, thread: ThreadId } = "stimulus-thread-empty", Warning, [always],
        "{place}: thread {thread} holds no program";
    /// Statements of a stimulus took no effect during the run.
    NeverHappened { statements: String } = "never-happened", Warning, [always],
        "never happened: {statements}";
    /// A statement of a stimulus gave an input the level that it had, each time.
    NothingChanged { place: String, state: String } = "nothing-changed", Warning, [always],
        "{place}: {state}: this action changes nothing";
    /// A statement of a stimulus limits something that nothing in the run moves.
    CannotFail { place: String, cause: String } = "cannot-fail", Warning, [always],
        "{place}: {cause}, so this cannot fail";
    /// A stimulus forbids a text that is printed in other letters.
    OtherLetters { place: String, printed: String } = "other-letters", Warning, [always],
        "{place}: \"{printed}\" is printed, in other letters: upper and lower case count";
    /// A stimulus has too many actions.
    TooMuchPlanned { most: usize } = "too-much-planned", Warning, [once],
        "the stimulus has more than {most} actions; later ones are left out";
    /// Devices answer each other without end.
    DevicesEndless { } = "devices-endless", Warning, [always],
        "devices on bits answer each other without end: they are disconnected";
    /// A firmware update starts.
    NoFirmwareToReplace { } = "no-firmware-to-replace", Warning, [always],
        "ClearFlashImage starts a firmware update, which the simulated board ignores";
    /// The released firmware stops at this script command.
    FirmwareStops { command: &'static str } = "firmware-stops", Warning, [always],
        "the released firmware stops at this use of `{command}`: it answers nothing until it is restarted";
    /// A line is G code.
    GCode { } = "g-code", Warning, [always],
        "G code is interpreted by the PC application: the board has no command for it";
    /// A command has another name in this firmware.
    CommandNamed { word: String, name: &'static str, board: String } = "command-named", Warning, [always],
        "{board} has no command {word}; its name there is {name}";
    /// A command belongs to later firmware.
    CommandLater { word: String, board: String } = "command-later", Warning, [always],
        "{word} is a command of later firmware than {board}, which the simulated board models";
    /// A command belongs to another firmware that can be simulated.
    CommandOfFirmware { command: &'static str, other: String, board: String, name: &'static str } = "command-of-firmware", Warning, [always],
        "`{command}` is a command of {other}; the simulated board models {board} (`--board {name}` models the other)";
    /// A command belongs to another board.
    CommandOtherBoard { word: String } = "command-other-board", Warning, [always],
        "{word} is a command of the Kogna board; the simulated board is a KFLOP";
    /// The simulated board is a Kogna.
    KognaUnproven { } = "kogna-unproven", Warning, [once],
        "the simulated Kogna is made from its header and manual, and was never compared with a board; times are those of a KFLOP";
    /// A command of a Kogna is not simulated.
    CommandNotSimulated { word: String } = "command-not-simulated", Warning, [always],
        "{word} is not simulated: what a Kogna answers to it is not known";
    /// A program calls a function of a Kogna that is not simulated.
    NotSimulated { function: &'static str } = "function-not-simulated", Warning, [always],
        "{function} is not simulated; the thread ends here";
    /// A program accesses a register of a Kogna that is not simulated.
    RegisterNotSimulated { number: u32 } = "register-not-simulated", Warning, [per number],
        "FPGA register {number:#x} of a Kogna is not simulated: it reads 0 and ignores writes";
    /// An axis of a Kogna takes a channel that is not simulated.
    ChannelNotSimulated { axis: AxisId, channel: i32 } = "channel-not-simulated", Warning, [per axis],
        "axis {axis}: the pins of step generator {channel} of a Kogna are not simulated; the load follows the axis all the same";
    /// Flash of a Kogna is not simulated.
    NoFlash { } = "flash-not-simulated", Warning, [always],
        "the flash memory of a Kogna is not simulated: nothing is saved";
}

#[cfg(test)]
mod tests;
