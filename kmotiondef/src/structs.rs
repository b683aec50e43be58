//! The structures that the header defines: one table each.
//!
//! A structure becomes an empty type of the same name that stands for it in the types of
//! places, and one typed [`Field`] constant for each of its fields, `Chan::DEST`. The
//! offsets are in the tables for the reader; that they are those of the C layout is
//! checked while this crate compiles.
//!
//! Source: table `api/structs.csv` of the specification, firmware 4.34.

use crate::ctype::{CType, Char, GuestType, Void};
use crate::place::Field;
use crate::start::StartValue::{self, Double, Fields, Float, Int, PerAxis, Zero};
use crate::start::StoreCondition;

/// A structure.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    /// Its name in C.
    pub name: &'static str,
    /// Its size in bytes.
    pub size: u32,
    /// Its alignment in bytes.
    pub align: u32,
    /// Its fields in ascending order.
    pub fields: &'static [StructureField],
}

/// A field of a structure.
#[derive(Clone, Copy, Debug)]
pub struct StructureField {
    /// Its name.
    pub name: &'static str,
    /// Its C type.
    pub ty: CType,
    /// Bytes from the start of the structure.
    pub offset: u32,
    /// Its size in bytes.
    pub size: u32,
    /// Its value at power-up.
    pub start: StartValue,
    /// The power-ups at which it is stored.
    pub stored: StoreCondition,
    /// Its meaning, with unit and range.
    pub doc: &'static str,
}

/// The offset of a field after one that ends at `end`, in C layout.
const fn aligned(end: u32, align: u32) -> u32 {
    end.next_multiple_of(align)
}

/// One structure: its names and size, then a row for each field.
///
/// A field's row is ``/// meaning`` then `FIELD = CName: type, at offset;`, or, if the board
/// puts something else than zeros there, `…, at offset, starts value;` for a value stored at
/// every power-up and `…, keeps value;` for one stored only when no user image has been flashed.
macro_rules! guest_struct {
    (@start) => { (Zero, StoreCondition::UnlessFlashed) };
    (@start starts $start:expr) => { ($start, StoreCondition::Always) };
    (@start keeps $start:expr) => { ($start, StoreCondition::UnlessFlashed) };
    (
        $(#[$struct_doc:meta])+
        $rust:ident = $c:ident, size $size:literal, align $align:literal;
        $(
            $(#[doc = $doc:literal])+
            $field:ident = $name:ident: $ty:ty, at $offset:literal $(, $stored:ident $start:expr)?;
        )*
    ) => {
        $(#[$struct_doc])+
        #[derive(Debug)]
        pub enum $rust {}

        impl GuestType for $rust {
            const C_TYPE: CType = CType::Named(stringify!($c));
            const SIZE: u32 = $size;
            const ALIGN: u32 = $align;
        }

        impl $rust {
            $($(#[doc = $doc])+ pub const $field: Field<$ty> = Field::new($offset);)*

            /// The structure with all its fields.
            pub const STRUCTURE: Structure = Structure {
                name: stringify!($c),
                size: $size,
                align: $align,
                fields: &[$(StructureField {
                    name: stringify!($name),
                    ty: <$ty>::C_TYPE,
                    offset: $offset,
                    size: <$ty>::SIZE,
                    start: guest_struct!(@start $($stored $start)?).0,
                    stored: guest_struct!(@start $($stored $start)?).1,
                    doc: concat!($($doc),+).trim_ascii_start(),
                }),*],
            };
        }

        const _: () = {
            let mut end = 0;
            $(
                assert!(aligned(end, <$ty>::ALIGN) == $offset, stringify!(offset of $c.$name));
                assert!(<$ty>::ALIGN <= $align, stringify!(alignment of $c));
                end = $offset + <$ty>::SIZE;
            )*
            assert!(aligned(end, $align) == $size, stringify!(size of $c));
        };
    };
}

/// Every structure, each after those it contains.
pub const STRUCTURES: &[Structure] = &[
    MainStatus::STRUCTURE,
    Persist::STRUCTURE,
    GatherValueDef::STRUCTURE,
    Gather::STRUCTURE,
    TripCircleLinear::STRUCTURE,
    TripLinear::STRUCTURE,
    ParametricCoeff::STRUCTURE,
    TripCoeff::STRUCTURE,
    Iir::STRUCTURE,
    Chan::STRUCTURE,
    Spindle::STRUCTURE,
];

guest_struct! {
    /// The status record that the board sends to the PC.
    MainStatus = MAIN_STATUS, size 464, align 8;

    /// STAT_VERSION, and in the lower half the words of the record.
    VERSION_AND_SIZE = VersionAndSize: i32, at 0;
    /// Raw readings: 8 on board or Kanalog, then 8 for each SnapAmp.
    ADC = ADC: [i32; 24], at 4;
    /// Analog outputs.
    DAC = DAC: [i32; 8], at 100;
    /// 8 on board, then 4 for each SnapAmp.
    PWM = PWM: [i32; 16], at 132;
    /// Measured position of each axis.
    POSITION = Position: [f64; 8], at 200;
    /// Destination of each axis.
    DEST = Dest: [f64; 8], at 264;
    /// First output channel of each axis.
    OUTPUT_CHAN0 = OutputChan0: [u8; 8], at 328;
    /// Input modes of axes 0-3, 4 bits an axis.
    INPUT_MODES = InputModes: i32, at 336;
    /// Input modes of axes 4-7.
    INPUT_MODES2 = InputModes2: i32, at 340;
    /// Output modes of axes 0-3, 4 bits an axis.
    OUTPUT_MODES = OutputModes: i32, at 344;
    /// Output modes of axes 4-7.
    OUTPUT_MODES2 = OutputModes2: i32, at 348;
    /// Enabled axes, one bit each.
    ENABLES = Enables: i32, at 352;
    /// Axes whose motion is finished, one bit each.
    AXIS_DONE = AxisDone: i32, at 356;
    /// Direction of I/O bits 0-63, 1 = output.
    BITS_DIRECTION = BitsDirection: [i32; 2], at 360;
    /// State of I/O bits 0-63.
    BITS_STATE = BitsState: [i32; 2], at 368;
    /// Directions of SnapAmp 0: bits 16-29, 1 = output.
    SNAP_BITS_DIRECTION0 = SnapBitsDirection0: i32, at 376;
    /// Directions of SnapAmp 1: bits 16-29, 1 = output.
    SNAP_BITS_DIRECTION1 = SnapBitsDirection1: i32, at 380;
    /// SnapAmp 0: 0-7 differential, 8-15 opto, 16-29 general.
    SNAP_BITS_STATE0 = SnapBitsState0: i32, at 384;
    /// SnapAmp 1: 0-7 differential, 8-15 opto, 16-29 general.
    SNAP_BITS_STATE1 = SnapBitsState1: i32, at 388;
    /// State of Kanalog inputs, I/O bits 128-143.
    KANALOG_BITS_STATE_INPUTS = KanalogBitsStateInputs: i32, at 392;
    /// State of Kanalog outputs, I/O bits 144-167.
    KANALOG_BITS_STATE_OUTPUTS = KanalogBitsStateOutputs: i32, at 396;
    /// Copy of persist.RunOnStartUp.
    RUN_ON_START_UP = RunOnStartUp: i32, at 400;
    /// Active threads, one bit each, bit 0 = primary thread.
    THREAD_ACTIVE = ThreadActive: i32, at 404;
    /// Copy of CS0_StoppingState.
    STOP_IMMEDIATE_STATE = StopImmediateState: i32, at 408;
    /// Seconds since power-up.
    TIME_STAMP = TimeStamp: f64, at 416;
    /// Copy of the request in persist.UserData[100..107].
    PC_COMM = PC_comm: [i32; 8], at 424;
    /// Copy of VirtualBits.
    VIRTUAL_BITS = VirtualBits: i32, at 456;
    /// Copy of the first word of VirtualBitsEx.
    VIRTUAL_BITS_EX0 = VirtualBitsEx0: i32, at 460;
}

guest_struct! {
    /// Kept over power-off once flashed.
    Persist = PERSIST, size 832, align 4;

    /// Threads to start at power-up: bit n = thread n, 1 to 7.
    RUN_ON_START_UP = RunOnStartUp: i32, at 0;
    /// Entry address of the program in thread index + 1.
    ENTRY_POINTS = EntryPoints: [u32; 7], at 4;
    /// Shared with the PC; also used as floats and doubles.
    USER_DATA = UserData: [i32; 200], at 32;
}

guest_struct! {
    /// One quantity that is recorded.
    GatherValueDef = GATHER_VALUE_DEF, size 8, align 4;

    /// GATHER_ ... _TYPE; 0 ends the list.
    TYPE = type: i32, at 0;
    /// The address that is sampled at each servo tick.
    ADDR = addr: *mut Void, at 4;
}

guest_struct! {
    /// The data recorder: at each servo tick, while bufptr is below endptr, one double is stored for every
    /// entry of the list.
    Gather = GATHER, size 280, align 8;

    /// Next place to store; recording goes on below endptr.
    BUFPTR = bufptr: *mut f64, at 0;
    /// End of recording.
    ENDPTR = endptr: *mut f64, at 4;
    /// Reference destination for injection, position units.
    DEST = Dest: f64, at 8;
    /// Nonzero: `list[0]` is set from bufptr, recording begins at `list[1]`.
    INJECT = Inject: i32, at 16;
    /// The quantities that are recorded at each tick, ended by type 0.
    LIST = list: [GatherValueDef; 32], at 20;
}

guest_struct! {
    /// Linear c*p + d, or circular c*sin(p*a + b) + d.
    TripCircleLinear = TRIP_CIRCLE_LINEAR, size 32, align 8;

    /// Angle span in radians, circular only.
    A = a: f64, at 0;
    /// Start angle in radians, circular only.
    B = b: f64, at 8;
    /// Linear: change of position; circular: radius. Position units.
    C = c: f64, at 16;
    /// Linear: start position; circular: centre. Position units.
    D = d: f64, at 24;
}

guest_struct! {
    /// Linear: c*p + d.
    TripLinear = TRIP_LINEAR, size 16, align 8;

    /// Change of position, position units.
    C = c: f64, at 0;
    /// Start position, position units.
    D = d: f64, at 8;
}

guest_struct! {
    /// One segment, p(t) = a*t^3 + b*t^2 + c*t + d, or a buffered command.
    ParametricCoeff = PARAMETRIC_COEFF, size 216, align 8;

    /// TRAJECTORY_OFF, _LINEAR, _CIRCULAR or _SPECIAL.
    TRAJECTORY_MODE = trajectory_mode: Char, at 0;
    /// Axis driven as X; in a TRAJECTORY_SPECIAL entry its command: 0, 1 clear or set the bit, 2, 3 hold
    /// until it is low or high, 4, 5 begin or end a rapid traverse.
    X_AXIS = x_axis: u8, at 1;
    /// Axis driven as Y.
    Y_AXIS = y_axis: u8, at 2;
    /// Axis driven as Z.
    Z_AXIS = z_axis: u8, at 3;
    /// Axis driven as A.
    A_AXIS = a_axis: u8, at 4;
    /// Axis driven as B.
    B_AXIS = b_axis: u8, at 5;
    /// Axis driven as C.
    C_AXIS = c_axis: u8, at 6;
    /// Axis driven as U.
    U_AXIS = u_axis: u8, at 7;
    /// Axis driven as V.
    V_AXIS = v_axis: u8, at 8;
    /// I/O bit of a TRAJECTORY_SPECIAL entry.
    SPECIAL_PARAM = special_param: i16, at 10;
    /// Duration of the segment in seconds.
    T = t: f64, at 16;
    /// Coefficient of t^3 in p(t), 1/s^3.
    A = a: f64, at 24;
    /// Coefficient of t^2 in p(t), 1/s^2.
    B = b: f64, at 32;
    /// Coefficient of t in p(t), 1/s.
    C = c: f64, at 40;
    /// Constant term of p(t).
    D = d: f64, at 48;
    /// Coordinate X.
    COORD_X = X: TripCircleLinear, at 56;
    /// Coordinate Y.
    COORD_Y = Y: TripCircleLinear, at 88;
    /// Coordinate Z.
    COORD_Z = Z: TripLinear, at 120;
    /// Coordinate A.
    COORD_A = A: TripLinear, at 136;
    /// Coordinate B.
    COORD_B = B: TripLinear, at 152;
    /// Coordinate C.
    COORD_C = C: TripLinear, at 168;
    /// Coordinate U.
    COORD_U = U: TripLinear, at 184;
    /// Coordinate V.
    COORD_V = V: TripLinear, at 200;
}

guest_struct! {
    /// One state of a profile: a*t^3 + b*t^2 + c*t + d, or exponential: a ratio per tick, b destination.
    TripCoeff = TRIP_COEFF, size 48, align 8;

    /// TRAJECTORY_OFF, _INDEPENDENT or _EXPONENTIAL.
    TRAJECTORY_MODE = trajectory_mode: i32, at 0;
    /// Duration of the state in seconds.
    T = t: f64, at 8;
    /// Coefficient of t^3, units/s^3 (one sixth of the jerk).
    A = a: f64, at 16;
    /// Coefficient of t^2, units/s^2 (half of the starting acceleration).
    B = b: f64, at 24;
    /// Coefficient of t, units/s (starting velocity).
    C = c: f64, at 32;
    /// Position at the start of the state, position units.
    D = d: f64, at 40;
}

guest_struct! {
    /// Second-order filter, output = B0*x + B1*x(-1) + B2*x(-2) + A1*y(-1) + A2*y(-2).
    Iir = IIR, size 28, align 4;

    /// Weight of the output one sample back.
    A1 = A1: f32, at 0;
    /// Weight of the output two samples back.
    A2 = A2: f32, at 4;
    /// Weight of the present input.
    B0 = B0: f32, at 8, keeps Float(1.0);
    /// Weight of the input one sample back.
    B1 = B1: f32, at 12;
    /// Weight of the input two samples back.
    B2 = B2: f32, at 16;
    /// First delay value (filter state).
    D0 = d0: f32, at 20, starts Zero;
    /// Second delay value (filter state).
    D1 = d1: f32, at 24, starts Zero;
}

guest_struct! {
    /// One axis. Position units are counts or steps, output units are counts of the PWM or DAC in use.
    Chan = CHAN, size 432, align 8;

    /// 0 to 7.
    CHAN_NUMBER = ChanNumber: i32, at 0, keeps PerAxis { first: 0, step: 1 };
    /// Nonzero when the servo is active.
    ENABLE = Enable: i32, at 4, starts Zero;
    /// Position source, NO_INPUT_MODE to USER_INPUT_MODE.
    INPUT_MODE = InputMode: i32, at 8, keeps Int(1);
    /// Output type, NO_OUTPUT_MODE to CL_MICROSTEP_MODE.
    OUTPUT_MODE = OutputMode: i32, at 12, keeps Zero;
    /// Bits 0, 1 act on the negative, positive limit; 2, 3 their polarity (1 acts when low); 4-7 the
    /// action: 0 disable, 1 forbid drive towards the limit, 2 stop; 8 take the bit numbers from the next
    /// two fields, else from bits 16-23 and 24-31.
    LIMIT_SWITCH_OPTIONS = LimitSwitchOptions: i32, at 16, keeps Zero;
    /// I/O bit of the negative limit.
    LIMIT_SWITCH_NEG_BIT = LimitSwitchNegBit: i32, at 20, keeps Zero;
    /// I/O bit of the positive limit.
    LIMIT_SWITCH_POS_BIT = LimitSwitchPosBit: i32, at 24, keeps Zero;
    /// Axis this one follows, -1 for none.
    MASTER_AXIS = MasterAxis: i32, at 28, starts Int(-1);
    /// Motion for one unit of the master.
    SLAVE_GAIN = SlaveGain: f64, at 32, starts Double(1.0);
    /// A larger position error disables the axis, position units.
    MAX_FOLLOWING_ERROR = MaxFollowingError: f64, at 40, keeps Double(1e9);
    /// Latest position error, position units.
    LAST_FOLLOWING_ERROR = LastFollowingError: f64, at 48, keeps Zero;
    /// Seconds inside the present profile state.
    T = t: f64, at 56, starts Zero;
    /// Destination the servo follows, position units.
    DEST = Dest: f64, at 64, starts Zero;
    /// Destination before the low-pass of coordinated motion, position units.
    UNFILTERED_DEST = UnfilteredDest: f64, at 72;
    /// Added to the destination (injection), position units.
    DEST_OFFSET = DestOffset: f64, at 80, starts Zero;
    /// Speed limit for moves, units/s.
    VEL = Vel: f32, at 88, keeps Float(4000.0);
    /// Acceleration limit for moves, units/s^2.
    ACCEL = Accel: f32, at 92, keeps Float(40_000.0);
    /// Jerk limit for moves, units/s^3.
    JERK = Jerk: f32, at 96, keeps Float(400_000.0);
    /// Acceleration feed-forward gain.
    FF_ACCEL = FFAccel: f32, at 100;
    /// Velocity feed-forward gain.
    FF_VEL = FFVel: f32, at 104;
    /// Measured position, position units.
    POSITION = Position: f64, at 112, starts Zero;
    /// Cycles per position unit; a cycle is four full steps or one commutation.
    INV_DIST_PER_CYCLE = invDistPerCycle: f64, at 120, keeps Double(1.0);
    /// Amplitude of microstepping at low speed, PWM counts.
    STEPPER_AMPLITUDE = StepperAmplitude: f32, at 128, keeps Float(20.0);
    /// Value last sent out, or the correction of a closed-loop stepper.
    OUTPUT = Output: f32, at 132, starts Zero;
    /// Output of the previous servo sample.
    PREV_OUTPUT = prev_output: f32, at 136, starts Zero;
    /// Lead compensation for a stepper motor's inductance.
    LEAD = Lead: f32, at 140, keeps Zero;
    /// Profile state being executed, NULL for none.
    PCOEFF = pcoeff: *mut TripCoeff, at 144, starts Zero;
    /// Measured position of the previous sample.
    LAST_POSITION = last_position: f64, at 152, starts Zero;
    /// Destination at the start of the previous sample, position units.
    LAST_DEST = last_dest: f64, at 160;
    /// Destination at the end of the previous sample, position units.
    PREV_DEST = prev_dest: f64, at 168;
    /// Direction of the last real movement: +1, -1, 0 unknown.
    LAST_NON_ZERO_DIR = LastNonZeroDir: i32, at 176;
    /// Direction of the present movement: +1, -1, 0 none.
    DIRECTION_OF_MOTION = DirectionOfMotion: i32, at 180;
    /// Speed of the destination in the previous sample, units/s.
    LAST_VEL = last_vel: f32, at 184;
    /// State of the lead compensation.
    X1_LAST = x1last: f32, at 188, starts Zero;
    /// State of the lead compensation.
    X2_LAST = x2last: f32, at 192, starts Zero;
    /// First PWM, DAC or step generator channel used by the axis.
    OUTPUT_CHAN0 = OutputChan0: i32, at 196, keeps PerAxis { first: 0, step: 2 };
    /// Second PWM channel used by the axis.
    OUTPUT_CHAN1 = OutputChan1: i32, at 200, keeps PerAxis { first: 1, step: 2 };
    /// First encoder or ADC channel used by the axis.
    INPUT_CHAN0 = InputChan0: i32, at 204, keeps PerAxis { first: 0, step: 1 };
    /// Second ADC channel used by the axis (resolver).
    INPUT_CHAN1 = InputChan1: i32, at 208, keeps PerAxis { first: 0, step: 1 };
    /// Offset added to input 0 after the gain.
    INPUT_OFFSET0 = InputOffset0: f32, at 212, keeps Zero;
    /// Gain of input 0; negative reverses an encoder.
    INPUT_GAIN0 = InputGain0: f32, at 216, keeps Float(1.0);
    /// Offset added to input 1 after the gain.
    INPUT_OFFSET1 = InputOffset1: f32, at 220, keeps Zero;
    /// Gain of input 1.
    INPUT_GAIN1 = InputGain1: f32, at 224, keeps Float(1.0);
    /// Factor applied to the output (negative reverses it).
    OUTPUT_GAIN = OutputGain: f32, at 228, starts Float(1.0);
    /// Offset added to the output.
    OUTPUT_OFFSET = OutputOffset: f32, at 232, starts Zero;
    /// Offset added to the position before commutation, position units.
    COMMUTATION_OFFSET = CommutationOffset: f32, at 236, keeps Zero;
    /// Resolver angle of the previous sample.
    LAST_THETA = last_theta: f32, at 240, starts Zero;
    /// Correction added to the resolver angle.
    THETA_CORRECTION = theta_correction: f32, at 244, starts Zero;
    /// Low byte of the hardware encoder count at the previous sample.
    LAST_ENC = last_enc: i8, at 248, starts Zero;
    /// Proportional gain, output units per position unit.
    P = P: f32, at 252, keeps Float(1.0);
    /// Integral gain, output units per position unit and sample.
    I = I: f32, at 256, keeps Zero;
    /// Derivative gain, output units per position unit a sample.
    D = D: f32, at 260, keeps Zero;
    /// Limit of the integrator, output units.
    MAX_I = MaxI: f32, at 264, keeps Float(200.0);
    /// Limit of the error that enters the compensator, position units.
    MAX_ERR = MaxErr: f32, at 268, keeps Float(1_000_000.0);
    /// Present integrator content.
    INTEGRATOR = integrator: f32, at 272, starts Zero;
    /// Limit of the output, output units.
    MAX_OUTPUT = MaxOutput: f32, at 276, keeps Float(200.0);
    /// Half width of the dead band around zero error, position units.
    DEAD_BAND_RANGE = DeadBandRange: f32, at 280, keeps Zero;
    /// Gain inside the dead band (1 = no dead band).
    DEAD_BAND_GAIN = DeadBandGain: f32, at 284, keeps Float(1.0);
    /// Kind of the last independent motion (LAST_MOTION_...).
    LAST_MOTION_TYPE = LastMotionType: i32, at 288;
    /// Target of the last independent motion, for the resume.
    LAST_MOTION_DEST = LastMotionDest: f64, at 296;
    /// Speed at which the curve of MoveExp begins, units/s.
    EXP_MOTION_VC = ExpMotionVc: f32, at 304;
    /// Distance at which the curve of MoveExp begins, position units.
    EXP_MOTION_XC = ExpMotionXc: f32, at 308;
    /// Negative soft limit, position units.
    SOFT_LIMIT_NEG = SoftLimitNeg: f32, at 312, starts Float(-1e30);
    /// Positive soft limit, position units.
    SOFT_LIMIT_POS = SoftLimitPos: f32, at 316, starts Float(1e30);
    /// BACKLASH_OFF or BACKLASH_LINEAR.
    BACKLASH_MODE = BacklashMode: i32, at 320, keeps Zero;
    /// Backlash to compensate, position units.
    BACKLASH_AMOUNT = BacklashAmount: f32, at 324, keeps Zero;
    /// Speed at which the compensation is applied, units/s.
    BACKLASH_RATE = BacklashRate: f32, at 328, keeps Zero;
    /// Direction of the last motion seen by the compensation: +1, -1, 0.
    BACKLASH_DIRECTION = BacklashDirection: i32, at 332, keeps Zero;
    /// Destination at which the direction was last decided, position units.
    PREV_BACKLASH_DEST = PrevBacklashDest: f32, at 336;
    /// Compensation being applied at present, position units.
    BACKLASH = Backlash: f32, at 340, keeps Zero;
    /// Profile coefficients: the axis' row of TripCoeffs.
    C = c: *mut TripCoeff, at 344, starts PerAxis { first: 0x80FF_9020, step: 960 };
    /// Filters in the servo path.
    IIR = iir: [Iir; 3], at 348, keeps Fields;
}

guest_struct! {
    /// Spindle measurement and threading.
    Spindle = SPINDLE, size 112, align 8;

    /// Spindle position in revolutions.
    POSITION = Position: f64, at 0;
    /// Position in revolutions at which threading motion begins.
    START_POSITION = StartPosition: f64, at 8;
    /// Position in revolutions at the last speed computation.
    LAST_UPDATE_POSITION = LastUpdatePosition: f64, at 16;
    /// Revolutions for one encoder count.
    REVS_PER_COUNT = RevsPerCount: f64, at 24;
    /// Servo tick at which the speed is computed next.
    UPDATE_TICK = UpdateTick: f64, at 32;
    /// Servo ticks between speed computations.
    DELTA_TICKS = DeltaTicks: f64, at 40;
    /// Filtered time of the motion, corrected for the lag, seconds.
    ADJ_TIME_FILT = AdjTimeFilt: f64, at 48;
    /// Coordinate-system time of the previous sample, seconds.
    LAST_CS_TIME = LastCSTime: f64, at 56;
    /// Address of the position used as spindle encoder.
    P_ENCODER_POS = pEncoderPos: *mut f64, at 64;
    /// Low-pass coefficient that belongs to Tau.
    K = K: f64, at 72;
    /// Measured speed, revolutions/s.
    TRUE_SPEED_RPS = TrueSpeedRPS: f32, at 80;
    /// Reciprocal of the speed the trajectory was planned for, s/rev.
    INV_BASE_SPEED_RPS = InvBaseSpeedRPS: f32, at 84;
    /// InvBaseSpeedRPS*(1-K).
    INV_BASE_SPEED_RPS_K1 = InvBaseSpeedRPSK1: f64, at 88;
    /// Reciprocal of the speed update time, 1/s.
    INV_UPDATE_TIME = InvUpdateTime: f32, at 96;
    /// Time constant of the spindle filter, seconds.
    TAU = Tau: f32, at 100;
    /// 0 no spindle feedback, 1 encoder.
    TYPE = Type: i32, at 104;
    /// Nonzero while threading is in progress.
    THREADING_ACTIVE = ThreadingActive: i32, at 108;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::table;

    #[test]
    fn rows_agree_with_the_specification() {
        let mut fields = 0;
        for row in table("structs.csv") {
            let structure =
                STRUCTURES.iter().find(|structure| structure.name == row["struct"]).expect("known");
            if row["field"] == "(struct)" {
                assert_eq!(structure.size.to_string(), row["size"], "{}", structure.name);
                assert_eq!(structure.align.to_string(), row["alignment"], "{}", structure.name);
                continue;
            }
            let field =
                structure.fields.iter().find(|field| field.name == row["field"]).expect(&row["field"]);
            let declared = format!("{}{}", row["c_type"].replace("short int", "short"), row["array_dims"]);
            assert_eq!(field.ty.to_string().replace(' ', ""), declared.replace(' ', ""), "{}", field.name);
            assert_eq!(field.offset.to_string(), row["offset"], "{}.{}", structure.name, field.name);
            assert_eq!(field.size.to_string(), row["size"], "{}.{}", structure.name, field.name);
            fields += 1;
        }
        assert_eq!(fields, STRUCTURES.iter().map(|structure| structure.fields.len()).sum::<usize>());
    }
}
