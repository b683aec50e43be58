//! The firmware variables: one row a variable, at the address the board has it.
//!
//! The compiler links against them by name, the kernel reads and writes them through the
//! typed places that bear their names in capitals ([`CHAN`], [`VIRTUAL_BITS`], …).
//!
//! Source: table `api/variables.csv` of the specification, firmware 4.34.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::ctype::{Bool, CType, Char, Const, GuestType, UserCallback, Volatile};
use crate::ids::{Axes, AxisId, GuestAddr};
use crate::limits::{N_CHANNELS, N_USER_DATA_VARS, VERSION};
use crate::place::Place;
use crate::start::StartValue::{self, Address, Double, Each, Fields, Float, Int, Text, Words, Zero};
use crate::start::StoreCondition;
use crate::structs::{Chan, Gather, ParametricCoeff, Persist, Spindle, StructureField, TripCoeff};

/// A firmware variable.
#[derive(Clone, Copy, Debug)]
pub struct FirmwareVariable {
    /// The name that programs use.
    pub name: &'static str,
    /// Its C type.
    pub ty: CType,
    /// Its address.
    pub address: GuestAddr,
    /// Its size in bytes.
    pub size: u32,
    /// Its value at power-up.
    pub start: StartValue,
    /// The power-ups at which it is stored.
    pub stored: StoreCondition,
    /// Its meaning.
    pub doc: &'static str,
}

/// The address of the UART's receive ring.
const RECEIVE_RING: GuestAddr = RS232_REC_BUF.address();
/// The address of the UART's transmit ring.
const TRANSMIT_RING: GuestAddr = RS232_TX_BUF.address();

/// The address of an axis' structure.
const fn axis(number: usize) -> GuestAddr {
    CHAN.element(number).address()
}

/// The number of axes in the tables, and of those beyond.
const TABLE_AXES: usize = N_CHANNELS;
const LATER_AXES: usize = Axes::MAX - TABLE_AXES;

/// The structures and profiles of the axes from 8 on, which a KFLOP does not have: in the tables they are outside
/// memory, and [`moved_objects`](crate::boards::moved_objects) has their addresses on a board.
pub(crate) const LATER_CHAN: Place<[Chan; LATER_AXES]> = Place::new(GuestAddr::new(0xE000_0000));
pub(crate) const LATER_TRIP_COEFFS: Place<[[TripCoeff; 20]; LATER_AXES]> =
    Place::new(GuestAddr::new(0xE001_0000));

/// The structure of an axis.
#[must_use]
#[inline]
pub const fn chan(axis: AxisId) -> Place<Chan> {
    match axis.index().checked_sub(TABLE_AXES) {
        None => CHAN.element(axis.index()),
        Some(later) => LATER_CHAN.element(later),
    }
}

/// The profile of an axis.
#[must_use]
#[inline]
pub const fn trip_coeffs(axis: AxisId) -> Place<[TripCoeff; 20]> {
    match axis.index().checked_sub(TABLE_AXES) {
        None => TRIP_COEFFS.element(axis.index()),
        Some(later) => LATER_TRIP_COEFFS.element(later),
    }
}

macro_rules! variables {
    (@stored starts) => { StoreCondition::Always };
    (@stored keeps) => { StoreCondition::UnlessFlashed };
    ($(
        $(#[doc = $doc:literal])+
        $place:ident = $name:ident: $ty:ty, at $address:literal, $stored:ident $start:expr;
    )*) => {
        $($(#[doc = $doc])+ pub const $place: Place<$ty> = Place::new(GuestAddr::new($address));)*

        /// Every firmware variable, in the order of the table.
        pub const FIRMWARE_VARIABLES: &[FirmwareVariable] = &[$(FirmwareVariable {
            name: stringify!($name),
            ty: <$ty>::C_TYPE,
            address: $place.address(),
            size: <$ty>::SIZE,
            start: $start,
            stored: variables!(@stored $stored),
            doc: concat!($($doc),+).trim_ascii_start(),
        }),*];
    };
}
crate::for_each_firmware_var!(variables);

/// The variable called `name`.
#[must_use]
pub fn variable_named(name: &str) -> Option<&'static FirmwareVariable> {
    static BY_NAME: LazyLock<BTreeMap<&str, &FirmwareVariable>> =
        LazyLock::new(|| FIRMWARE_VARIABLES.iter().map(|variable| (variable.name, variable)).collect());
    BY_NAME.get(name).copied()
}

/// The variable that holds the byte at `address`.
#[must_use]
pub fn variable_around(address: GuestAddr) -> Option<&'static FirmwareVariable> {
    static BY_ADDRESS: LazyLock<BTreeMap<GuestAddr, &FirmwareVariable>> =
        LazyLock::new(|| FIRMWARE_VARIABLES.iter().map(|variable| (variable.address, variable)).collect());
    let (start, variable) = BY_ADDRESS.range(..=address).next_back()?;
    (address.get() - start.get() < variable.size).then_some(*variable)
}

/// The name that programs use for `size` bytes at an address: an element of `persist.UserData`, a variable and an offset
/// in it, or the address.
#[must_use]
pub fn cell_name(address: GuestAddr, size: u32) -> String {
    let data = PERSIST.field(Persist::USER_DATA).element(0).address().get();
    let element = address.get().wrapping_sub(data) / 4;
    if (element as usize) < N_USER_DATA_VARS {
        return match size {
            8 => format!("persist.UserData[{element}] and [{}]", element + 1),
            _ => format!("persist.UserData[{element}]"),
        };
    }
    match variable_around(address) {
        Some(variable) if variable.name == CHAN_NAME => field_of_axis(address.get() - variable.address.get()),
        Some(variable) if variable.address == address => variable.name.to_owned(),
        Some(variable) => format!("{} + {}", variable.name, address.get() - variable.address.get()),
        None => address.to_string(),
    }
}

/// The name of the array of axes.
const CHAN_NAME: &str = "chan";

/// The name of an axis field at a byte offset in the array of axes.
fn field_of_axis(byte: u32) -> String {
    let (axis, offset) = (byte / Chan::STRUCTURE.size, byte % Chan::STRUCTURE.size);
    let is_around = |field: &&StructureField| (field.offset..field.offset + field.size).contains(&offset);
    match Chan::STRUCTURE.fields.iter().find(is_around) {
        Some(field) if field.offset == offset => format!("chan[{axis}].{}", field.name),
        Some(field) => format!("chan[{axis}].{} + {}", field.name, offset - field.offset),
        None => format!("chan[{axis}] + {offset}"),
    }
}

/// Hands every row of the table of firmware variables to the macro `$m`.
///
/// Rules of the table:
/// - A row is ``/// meaning`` then `PLACE = CName: type, at address, starts value;`.
/// - Types are those of [`ctype`](crate::ctype), values those of [`StartValue`](crate::start::StartValue).
/// - `starts` is stored at every power-up, `keeps` only when no user image has been flashed.
#[macro_export]
macro_rules! for_each_firmware_var {
    ($m:ident) => {
        $m! {
            // ---- axes ---------------------------------------------------------------------------------
            /// The eight axes.
            CHAN = chan: [Chan; 8], at 0x1001_7F08, starts Fields;
            /// Axis 0.
            CH0 = ch0: *mut Chan, at 0x1001_8C88, starts Address(axis(0));
            /// Axis 1.
            CH1 = ch1: *mut Chan, at 0x1001_8C8C, starts Address(axis(1));
            /// Axis 2.
            CH2 = ch2: *mut Chan, at 0x1001_8C90, starts Address(axis(2));
            /// Axis 3.
            CH3 = ch3: *mut Chan, at 0x1001_8C94, starts Address(axis(3));
            /// Axis 4.
            CH4 = ch4: *mut Chan, at 0x1001_8C98, starts Address(axis(4));
            /// Axis 5.
            CH5 = ch5: *mut Chan, at 0x1001_8C9C, starts Address(axis(5));
            /// Axis 6.
            CH6 = ch6: *mut Chan, at 0x1001_8CA0, starts Address(axis(6));
            /// Axis 7.
            CH7 = ch7: *mut Chan, at 0x1001_8CA4, starts Address(axis(7));
            /// Profiles of independent moves; `chan[n].c` is row n.
            TRIP_COEFFS = TripCoeffs: [[TripCoeff; 20]; 8], at 0x80FF_9020, starts Zero;
            /// Position units per radian of resolver angle.
            RESOLVER_FACTOR = ResolverFactor: f64, at 0x1001_8DE0, starts Double(159.154_943_091_895_35);
            /// Called at every servo sample, if not NULL; has to return within microseconds.
            USER_CALL_BACK = UserCallBack: *mut UserCallback, at 0x1001_7E18, starts Zero;

            // ---- time and threads ---------------------------------------------------------------------
            /// Servo samples since power-up.
            SERVO_TICK = ServoTick: Volatile<f64>, at 0x1001_8DD0, starts Zero;
            /// TIMER0 at the moment ServoTick was raised.
            LAST_TIMER0 = LastTimer0: Volatile<u32>, at 0x1001_8DD8, starts Zero;
            /// Thread being executed: 0 the primary one, 1 to 7 user threads.
            CURRENT_THREAD = CurrentThread: i32, at 0x1001_6CCC, starts Zero;

            // ---- the PC -------------------------------------------------------------------------------
            /// Shared with the PC and kept over power-off once flashed.
            PERSIST = persist: Persist, at 0x1001_6CE0, keeps Zero;
            /// State of the PC application; bit 0: a job is running.
            HOST_STATUS = HostStatus: Volatile<i32>, at 0x1001_AC84, starts Zero;
            /// Raised whenever an edit control of the PC changes.
            EDIT_CHANGE_COUNT = EditChangeCount: Volatile<i32>, at 0x1001_AC88, starts Zero;
            /// Raised with every status request of the PC.
            STATUS_REQUEST_COUNTER = StatusRequestCounter: i32, at 0x1001_71C4, starts Zero;
            /// Board name, firmware version and build time.
            VERSION_AND_BUILD_TIME = VersionAndBuildTime: [Const<Char>; 39], at 0x1001_B958,
                starts Text(VERSION);
            /// Write index of the console queue.
            NEXT_AVAIL_IN = NextAvailIn: Volatile<i32>, at 0x1001_A008, starts Zero;
            /// Read index of the console queue; equal: empty.
            NEXT_AVAIL_OUT = NextAvailOut: Volatile<i32>, at 0x1001_A00C, starts Zero;
            /// 0 no line yet, 1 arrived, 2 failure, 3 no more.
            READ_DISK_BUFFER_STATUS = read_disk_buffer_status: Volatile<i32>, at 0x1001_A010, starts Zero;
            /// Line from a file of the PC.
            READ_DISK_BUFFER = read_disk_buffer: [Char; 1025], at 0x1001_A014, starts Zero;

            // ---- data recorder ------------------------------------------------------------------------
            /// Descriptor of the data recorder, which runs at every servo tick.
            GATHER = gather: Gather, at 0x1001_8CA8, starts Words(&[0xFFFF_FFF8, 0]);
            /// MAX_GATHER_DATA doubles: recordings, and texts and data for the PC.
            GATHER_BUFFER = gather_buffer: *mut f64, at 0x1001_8DC0,
                starts Address(GuestAddr::new(0x8010_2010));
            /// Work buffer of N_CPLX floats for Bode measurements.
            INPUT = input: *mut f32, at 0x1001_7E14, starts Address(GuestAddr::new(0x8010_0008));

            // ---- coordinated motion -------------------------------------------------------------------
            /// Axis used as X, -1 for none.
            CS0_AXIS_X = CS0_axis_x: i32, at 0x1001_ACC8, keeps Int(0);
            /// Axis used as Y, -1 for none.
            CS0_AXIS_Y = CS0_axis_y: i32, at 0x1001_ACCC, keeps Int(1);
            /// Axis used as Z, -1 for none.
            CS0_AXIS_Z = CS0_axis_z: i32, at 0x1001_ACD0, keeps Int(2);
            /// Axis used as A, -1 for none.
            CS0_AXIS_A = CS0_axis_a: i32, at 0x1001_ACD4, keeps Int(3);
            /// Axis used as B, -1 for none.
            CS0_AXIS_B = CS0_axis_b: i32, at 0x1001_ACD8, starts Int(-1);
            /// Axis used as C, -1 for none.
            CS0_AXIS_C = CS0_axis_c: i32, at 0x1001_ACDC, starts Int(-1);
            /// Axis used as U, -1 for none.
            CS0_AXIS_U = CS0_axis_u: i32, at 0x1001_ACE0, starts Int(-1);
            /// Axis used as V, -1 for none.
            CS0_AXIS_V = CS0_axis_v: i32, at 0x1001_ACE4, starts Int(-1);
            /// Seconds inside the segment being executed.
            CS0_T = CS0_t: f64, at 0x1001_7E28, starts Zero;
            /// Seconds of all segments completed.
            CS0_TIME_EXECUTED = CS0_TimeExecuted: f64, at 0x1001_7E30, starts Zero;
            /// Seconds of all segments put into the buffer.
            CS0_TIME_DOWNLOADED = CS0_TimeDownloaded: f64, at 0x1001_7E48, starts Zero;
            /// Seconds of segments already overwritten.
            CS0_TIME_LOST = CS0_TimeLost: f64, at 0x1001_7E50, starts Zero;
            /// Seconds that motion advances in a tick, negative backwards.
            CS0_TIME_BASE = CS0_TimeBase: f64, at 0x1001_7E38, starts Double(9e-5);
            /// Largest change of CS0_TimeBase in a tick, seconds.
            CS0_TIME_BASE_DELTA = CS0_TimeBaseDelta: f64, at 0x1001_7E40, starts Zero;
            /// The value that CS0_TimeBase is being ramped to, seconds a tick.
            CS0_TIME_BASE_DESIRED = CS0_TimeBaseDesired: f64, at 0x1001_7E58, starts Double(9e-5);
            /// Seconds to a stop, computed when a feedhold begins.
            CS0_DECEL_TIME = CS0_DecelTime: f32, at 0x1001_7E7C, starts Float(1.0);
            /// Nominal deceleration time over 2·TIMEBASE².
            CS0_NOM_DECEL_2TB2 = CS0_NomDecel2TB2: f32, at 0x1001_7E68, starts Float(15_432_099.0);
            /// Nonzero in a rapid traverse.
            CS0_DOING_RAPID = CS0_DoingRapid: Bool, at 0x1001_7E74, starts Zero;
            /// Nonzero: running out of segments is the end.
            CS0_FLUSHED = CS0_Flushed: Bool, at 0x1001_7E60, starts Zero;
            /// Nonzero: hold at the end of the buffer, do not end.
            CS0_HOLD_AT_END = CS0_HoldAtEnd: Bool, at 0x1001_7E64, starts Zero;
            /// 0 none, 1 stopping, 3 stopped; 2, 4 the same for independent motion.
            CS0_STOPPING_STATE = CS0_StoppingState: i32, at 0x1001_7E78, starts Zero;
            /// Feed override last requested; applies when a feedhold is released.
            CS0_LAST_FRO = CS0_LastFRO: f32, at 0x1001_7E6C, starts Float(1.0);
            /// Rapid override last requested; applies when a feedhold is released.
            CS0_LAST_RAPID_FRO = CS0_LastRapidFRO: f32, at 0x1001_7E70, starts Float(1.0);
            /// Segment being executed, NULL for none.
            COORD_SYSTEM0 = CoordSystem0: *mut ParametricCoeff, at 0x1001_7F00, starts Zero;
            /// Last segment executed when motion ended.
            LAST_COORD_SYSTEM0 = LastCoordSystem0: *mut ParametricCoeff, at 0x1001_7F04, starts Zero;
            /// Last segment that produced motion.
            LAST_VALID_TRAJ_SEGMENT = LastValidTrajSegment: *mut ParametricCoeff, at 0x1001_9038, starts Zero;
            /// Start of the buffer of MAX_SEGMENTS entries.
            PARAMETRIC_COEFFS = ParametricCoeffs: *mut ParametricCoeff, at 0x1001_7E1C,
                starts Address(GuestAddr::new(0x808A_B220));
            /// First address after the buffer.
            PARAMETRIC_COEFFS_END = ParametricCoeffsEnd: *mut ParametricCoeff, at 0x1001_7E20,
                starts Address(GuestAddr::new(0x80FE_0D60));
            /// Entry the next segment or command will be put into.
            PARAMETRIC_INDEX = ParametricIndex: i32, at 0x1001_6CD4, starts Zero;
            /// Nonzero once new segments overwrite old ones.
            PARAMETRIC_INDEX_WRAPPED = ParametricIndexWrapped: Bool, at 0x1001_6CD8, starts Zero;
            /// Low-pass on destinations: exp(-TIMEBASE / Tau), 0 for none.
            KLP = KLP: f64, at 0x1001_8E48, starts Zero;
            /// Time constant that belongs to KLP, seconds.
            TAU_KLP = TauKLP: f32, at 0x1001_8EC0, starts Zero;
            /// Duration of the final spline in multiples of TauKLP.
            SPLINE_TAU_FACTOR = SplineTauFactor: f32, at 0x1001_8EC4, starts Float(2.0);
            /// Spindle measurement and threading.
            SPINDLE = Spindle: Spindle, at 0x1001_8E50, starts Zero;

            // ---- inputs and outputs -------------------------------------------------------------------
            /// Bits in memory: the low 16 are I/O bits 48 to 63.
            VIRTUAL_BITS = VirtualBits: i32, at 0x1001_A880, starts Zero;
            /// Bits in memory: I/O bits 1024 to 2047, 32 a word.
            VIRTUAL_BITS_EX = VirtualBitsEx: [i32; 32], at 0x1001_A884, starts Zero;
            /// Directions of bits 0 to 63, 1 = output.
            BIT_DIR_SHADOW = BitDirShadow: [i32; 2], at 0x1001_A870, starts Words(&[0, 0xC000]);
            /// Directions of SnapAmp 0, 14 bits, 1 = output.
            BIT_DIR_SHADOW_SNAP0 = BitDirShadowSnap0: i32, at 0x1001_A878, starts Zero;
            /// Directions of SnapAmp 1, 14 bits, 1 = output.
            BIT_DIR_SHADOW_SNAP1 = BitDirShadowSnap1: i32, at 0x1001_A87C, starts Zero;
            /// Words of the outputs, (v - 2048) & 0xFFF for v.
            DAC_BUFFER = DAC_Buffer: [i16; 8], at 0x1001_A918, starts Each(2048);
            /// Latest raw conversions, 0 to 4095.
            ADC_BUFFER_IN = ADC_BufferIn: [i32; 8], at 0x1001_A948, starts Each(2048);
            /// A board: 4 currents, 2 voltages, 2 temperatures.
            ADC_BUFFER_IN_SNAP = ADC_BufferInSnap: [i32; 16], at 0x1001_9048, starts Zero;
            /// Last words sent: 8 on board, then 4 for each SnapAmp.
            LAST_PWM = LastPWM: [i32; 16], at 0x1001_AC30, starts Zero;

            // ---- option boards ------------------------------------------------------------------------
            /// SnapAmp boards found at power-up.
            SNAP_AMP_PRESENT = SnapAmpPresent: i32, at 0x1001_AC70, starts Zero;
            /// Nonzero, flashed: JP7 is not probed at power-up.
            DISABLE_SNAP_AMP_DETECT_ON_BOOT = DisableSnapAmpDetectOnBoot: i32, at 0x1001_AC80, keeps Zero;
            /// 1 when a Kanalog was found at power-up.
            KANALOG_PRESENT = KanalogPresent: i32, at 0x1001_AC74, starts Zero;
            /// Nonzero, flashed: JP4 is not probed at power-up.
            DISABLE_KANALOG_DETECT_ON_BOOT = DisableKanalogDetectOnBoot: i32, at 0x1001_AC78, keeps Zero;
            /// Set by a program: KStep inputs become bits 168 to 183.
            KSTEP_PRESENT = KStepPresent: i32, at 0x1001_AC7C, starts Zero;

            // ---- the UART -----------------------------------------------------------------------------
            /// Nonzero: characters go to the command interpreter.
            DO_RS232_CMDS = DoRS232Cmds: Volatile<i32>, at 0x1001_90A0, starts Zero;
            /// Write position in the receive ring, moved by the firmware.
            P_RS232_REC_IN = pRS232RecIn: Volatile<*mut Char>, at 0x1001_9088, starts Address(RECEIVE_RING);
            /// Read position in the receive ring; equal: empty.
            P_RS232_REC_OUT = pRS232RecOut: *mut Char, at 0x1001_908C, starts Address(RECEIVE_RING);
            /// Write position in the transmit ring.
            P_RS232_TX_IN = pRS232TxIn: *mut Char, at 0x1001_9090, starts Address(TRANSMIT_RING);
            /// Read position in the transmit ring, moved by the firmware.
            P_RS232_TX_OUT = pRS232TxOut: Volatile<*mut Char>, at 0x1001_9094, starts Address(TRANSMIT_RING);
            /// Receive ring.
            RS232_REC_BUF = RS232RecBuf: [Char; 1000], at 0x1001_90A4, starts Zero;
            /// Transmit ring.
            RS232_TX_BUF = RS232TxBuf: [Char; 1000], at 0x1001_948C, starts Zero;
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{Row, table};

    #[test]
    fn variables_do_not_overlap() {
        let mut variables = FIRMWARE_VARIABLES.to_vec();
        variables.sort_by_key(|variable| variable.address);
        for pair in variables.windows(2) {
            assert!(pair[0].address.offset(pair[0].size) <= pair[1].address, "{}", pair[0].name);
        }
    }

    #[test]
    fn an_address_inside_a_variable_finds_it() {
        let name = |address| variable_around(GuestAddr::new(address)).map(|variable| variable.name);
        assert_eq!(name(0x1001_7F08 + 431), Some("chan"));
        assert_eq!(name(0x1001_8C88), Some("ch0"));
        assert_eq!(name(0x1001_6CC0), None);
        assert_eq!(name(0x8005_0000), None);
    }

    #[test]
    fn rows_agree_with_the_specification() {
        let specified = table("variables.csv");
        let linkable: Vec<&Row> = specified.iter().filter(|row| !row["address"].is_empty()).collect();
        for row in &linkable {
            let variable = variable_named(&row["name"]).expect(&row["name"]);
            let declared = row["c_type"].replace("short int", "short");
            assert_eq!(
                variable.ty.to_string().replace(' ', ""),
                declared.replace(' ', ""),
                "{}",
                row["name"]
            );
            assert_eq!(format!("0x{:08X}", variable.address.get()), row["address"], "{}", row["name"]);
            assert_eq!(variable.size.to_string(), row["size_bytes"], "{}", row["name"]);
        }
        assert_eq!(linkable.len(), FIRMWARE_VARIABLES.len());
    }

    #[test]
    fn pointers_start_where_the_specification_says() {
        for row in table("variables.csv").iter().filter(|row| row["pointee"].contains("0x")) {
            let from = row["pointee"].find("0x").expect("just seen");
            let pointee =
                u32::from_str_radix(&row["pointee"][from + 2..from + 10], 16).expect("eight digits");
            let start = variable_named(&row["name"]).expect(&row["name"]).start;
            assert_eq!(start, StartValue::Address(GuestAddr::new(pointee)), "{}", row["name"]);
        }
    }
}
