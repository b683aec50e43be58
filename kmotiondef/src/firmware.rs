//! The firmware functions: one row a function, everything mechanical expanded from it.
//!
//! [`for_each_firmware_fn!`](crate::for_each_firmware_fn) hands the table to a macro of the
//! caller's. Here it becomes [`FIRMWARE_FUNCTIONS`], which the linker and the documentation
//! read; the runtime expands the same rows to its dispatch, so that a function without an
//! implementation is a compile error that names it.
//!
//! Source: tables `api/functions.csv` of the specification, firmware 4.34; the functions of
//! origin `library` are those that programs expect and firmware 4.34 lacks
//! (`api/README.md`, `dialect.md` section 5).
//!
//! The file is as long as the board has functions: after the hundred lines of the row's type there is nothing but
//! rows, and a row cut off from the others would be looked for in two places.

use std::fmt;
use std::num::NonZeroU16;

use crate::GuestAddr;
use crate::ctype::{
    CType, Char, File, GuestType, Long, Role, SizeT, UnsignedLong, ValueClass, Void, Volatile,
};
use crate::function::{
    ALL, Attributes, AxisNumber, BitNumber, BoundedInt, FileName, NOT_B3, PolledState, PrintFormat,
    ScanFormat, ThreadNumber,
};
use crate::ids::Cycles;
use crate::limits::{MAX_PWM_VALUE, MAX_PWMC_VALUE, MAX_PWMR_VALUE};
use crate::structs::Chan;

/// The origin of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// In the firmware, and the header declares it.
    Header,
    /// In the firmware, but a program must declare it itself or rely on an implicit declaration.
    Firmware,
    /// Not in firmware 4.34: supplied by the simulation. A program's own definition wins.
    Library,
}

/// A parameter of a firmware function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its C type.
    pub ty: CType,
    /// The meaning of the argument.
    pub role: Role,
}

/// A firmware function.
#[derive(Clone, Copy, Debug)]
pub struct FirmwareFunction {
    /// The name that programs use.
    pub name: &'static str,
    /// The address at which programs call it.
    pub address: GuestAddr,
    /// Its named parameters.
    pub params: &'static [Parameter],
    /// True if more arguments may follow.
    pub is_variadic: bool,
    /// The type of its result.
    pub result: CType,
    /// The cycles of a call, apart from waiting and from the part that depends on its arguments (costs.md section 2:
    /// the released firmware, 44 cycles for each access to the FPGA).
    pub cost: Cycles,
    /// Its origin: firmware or library.
    pub origin: Origin,
    /// The group it belongs to, a file of the runtime.
    pub group: &'static str,
    /// Its name in the runtime.
    pub rust_name: &'static str,
    /// A description in one line.
    pub doc: &'static str,
    /// Facts beside signature and cost.
    pub attributes: Attributes,
}

impl FirmwareFunction {
    /// The function's prototype in C, without the semicolon.
    #[must_use]
    pub fn prototype(&self) -> String {
        let mut params: Vec<_> = self.params.iter().map(|param| param.ty.declare(param.name)).collect();
        if self.is_variadic {
            params.push("...".to_owned());
        }
        if params.is_empty() {
            params.push("void".to_owned());
        }
        self.result.declare(&format!("{}({})", self.name, params.join(", ")))
    }

    /// The position of the argument with a role, counted from 0.
    #[must_use]
    pub fn argument(&self, is_meant: impl Fn(Role) -> bool) -> Option<usize> {
        self.params.iter().position(|param| is_meant(param.role))
    }

    /// The class of each named parameter. The address of the variable part, if there is one, follows them.
    pub fn param_classes(&self) -> impl Iterator<Item = ValueClass> {
        self.params.iter().filter_map(|param| param.ty.class())
    }
}

/// Declared by the header, but not in firmware 4.34: a use does not link.
pub const ABSENT: &[&str] = &["MainStatus", "WriteDAC"];

/// The first address for functions of [`Origin::Library`]; each takes 8.
pub const LIBRARY_BASE: GuestAddr = GuestAddr::new(0x7000_0000);

macro_rules! functions {
    (@origin header) => { Origin::Header };
    (@origin firmware) => { Origin::Firmware };
    (@origin library) => { Origin::Library };
    (@result) => { CType::Void };
    (@result $result:ty) => { <$result>::C_TYPE };
    (@variadic) => { false };
    (@variadic varargs) => { true };
    ($(
        $(#[doc = $doc:literal])+
        $group:ident::$function:ident =
            $name:ident($($param:ident: $ty:ty),* $(; $varargs:ident)?) $(-> $result:ty)?,
            at $address:literal, cost $cost:literal, $origin:ident
            $(, $attribute:ident $(($($value:expr),*))?)*;
    )*) => {
        /// The number of a firmware function, under the function's name.
        #[expect(non_camel_case_types, reason = "the names are those of C")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[repr(u16)]
        pub enum Function {
            $($(#[doc = $doc])+ $name),*
        }

        impl Function {
            /// Every function, in the order of the table.
            pub const ALL: &[Self] = &[$(Self::$name),*];
        }

        /// Every firmware function, in the order of the table: its position is its number.
        pub const FIRMWARE_FUNCTIONS: &[FirmwareFunction] = &[$(FirmwareFunction {
            name: stringify!($name),
            address: GuestAddr::new($address),
            params: &[$(Parameter {
                name: stringify!($param),
                ty: <$ty>::C_TYPE,
                role: <$ty>::ROLE,
            }),*],
            is_variadic: functions!(@variadic $($varargs)?),
            result: functions!(@result $($result)?),
            cost: Cycles::new($cost),
            origin: functions!(@origin $origin),
            group: stringify!($group),
            rust_name: stringify!($function),
            doc: concat!($($doc),+).trim_ascii_start(),
            attributes: Attributes::NONE$(.$attribute($($($value),*)?))*,
        }),*];
    };
}
crate::for_each_firmware_fn!(functions);

impl Function {
    /// The row of the table.
    #[must_use]
    pub const fn row(self) -> &'static FirmwareFunction {
        &FIRMWARE_FUNCTIONS[self as usize]
    }

    /// The name that programs use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().name
    }
}

impl fmt::Display for Function {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The row of the function called `name`.
#[must_use]
pub fn row_named(name: &str) -> Option<&'static FirmwareFunction> {
    FIRMWARE_FUNCTIONS.get(function_named(name)?)
}

/// The number of the function called `name`.
#[must_use]
pub fn function_named(name: &str) -> Option<usize> {
    let at =
        BY_NAME.binary_search_by(|number| FIRMWARE_FUNCTIONS[usize::from(*number)].name.cmp(name)).ok()?;
    Some(usize::from(BY_NAME[at]))
}

/// The numbers of the functions in the order of their names.
static BY_NAME: [u16; FIRMWARE_FUNCTIONS.len()] = by_name();

const fn by_name() -> [u16; FIRMWARE_FUNCTIONS.len()] {
    let mut table = [0; FIRMWARE_FUNCTIONS.len()];
    let mut number = 0;
    while number < table.len() {
        let mut at = number;
        while at > 0
            && is_before(FIRMWARE_FUNCTIONS[number].name, FIRMWARE_FUNCTIONS[table[at - 1] as usize].name)
        {
            table[at] = table[at - 1];
            at -= 1;
        }
        table[at] = number as u16;
        number += 1;
    }
    table
}

/// Reports whether a name comes before another one.
const fn is_before(name: &str, other: &str) -> bool {
    let (name, other) = (name.as_bytes(), other.as_bytes());
    let mut at = 0;
    while at < name.len() && at < other.len() && name[at] == other[at] {
        at += 1;
    }
    at < other.len() && (at == name.len() || name[at] < other[at])
}

/// The number of the function that starts at `address`.
///
/// Every call of a program asks this, so it is a table of hashes that is made when cc67 is compiled.
#[must_use]
pub fn function_at(address: GuestAddr) -> Option<usize> {
    let mut slot = slot(address);
    loop {
        let number = BY_ADDRESS[slot]?.get() as usize - 1;
        if FIRMWARE_FUNCTIONS[number].address.get() == address.get() {
            return Some(number);
        }
        slot = (slot + 1) % SLOTS;
    }
}

/// The number of slots of the hash table: a power of two, at least twice the number of functions.
const SLOTS: usize = 1 << SLOT_BITS;
const SLOT_BITS: u32 = 10;

/// The number of a function plus one, in the slot of its address or the next free one.
static BY_ADDRESS: [Option<NonZeroU16>; SLOTS] = by_address();

/// Multiplicative hashing: the golden ratio spreads adjacent addresses.
const fn slot(address: GuestAddr) -> usize {
    (address.get().wrapping_mul(0x9E37_79B1) >> (u32::BITS - SLOT_BITS)) as usize
}

const fn by_address() -> [Option<NonZeroU16>; SLOTS] {
    assert!(2 * FIRMWARE_FUNCTIONS.len() <= SLOTS);
    let mut table = [None; SLOTS];
    let mut number = 0;
    while number < FIRMWARE_FUNCTIONS.len() {
        let mut slot = slot(FIRMWARE_FUNCTIONS[number].address);
        while table[slot].is_some() {
            slot = (slot + 1) % SLOTS;
        }
        number += 1;
        table[slot] = NonZeroU16::new(number as u16);
    }
    table
}

/// Hands every row of the table of firmware functions to the macro `$m`.
///
/// Rules of the table:
/// - A row is ``/// meaning`` then `group::rust_name = CName(param: type, …) -> type, at address,
///   cost n, origin, attributes;`. No result means `void`; `; varargs` after the last parameter means `, ...`.
/// - Types are those of [`ctype`](crate::ctype): `i32` is `int`, `*const Char` is `const char *`. A type of
///   [`function`](crate::function) names the role of the argument as well: `AxisNumber`, `BitNumber`, `PrintFormat`.
/// - The cost is in cycles of 5 ns, waiting not included.
/// - The origin is `header`, `firmware` or `library`, see [`Origin`](crate::firmware::Origin).
/// - The attributes are the methods of [`function`](crate::function): `waits("until …")`, `polls(PolledState::Bit)`,
///   `drives_axis`, `reads_bit`, `writes_bit`, `pure`, `stack(bytes)`, `changes(A, B)`.
/// - The position in the table is the function's number. Library rows have ascending addresses.
///
/// The runtime needs the paths alone and lets Rust infer the rest from its functions:
///
/// ```text
/// macro_rules! handlers {
///     ($($(#[$doc:meta])* $group:ident::$function:ident = $name:ident $params:tt
///         $(-> $result:ty)?, at $address:literal, cost $cost:literal, $origin:ident $(, $attribute:ident $(($($value:tt)*))?)*;)*) => {
///         /// One handler a function, by its number.
///         const HANDLERS: &[Handler] = &[$(Handler::new($group::$function)),*];
///     };
/// }
/// kmotiondef::for_each_firmware_fn!(handlers);
/// ```
#[macro_export]
macro_rules! for_each_firmware_fn {
    ($m:ident) => {
        $m! {
            // ---- io: digital and analog inputs and outputs, FPGA outputs ------------------------------
            /// Makes a bit an output (`dir` nonzero) or an input (0). Bits 0 to 45 and SnapAmp GPIO only.
            io::set_bit_direction = SetBitDirection(bit: BitNumber, dir: i32), at 0x8002_4720, cost 136, header,
                writes_bit;
            /// 1 if the bit is an output, 0 if it is an input.
            io::get_bit_direction = GetBitDirection(bit: BitNumber) -> i32, at 0x8002_49B4, cost 40, header;
            /// Drives an output bit high; of an input it sets the latch that appears when it becomes an
            /// output.
            io::set_bit = SetBit(bit: BitNumber), at 0x1001_1D80, cost 86, header, writes_bit;
            /// Drives an output bit low; of an input it clears the latch that appears when it becomes an
            /// output.
            io::clear_bit = ClearBit(bit: BitNumber), at 0x1001_1F88, cost 87, header, writes_bit;
            /// Drives an output bit high if `state` is nonzero, else low.
            io::set_state_bit = SetStateBit(bit: BitNumber, state: i32), at 0x1001_21AC, cost 125, header,
                writes_bit;
            /// State of a bit, 0 or 1: an output's own state, an input's pin.
            io::read_bit = ReadBit(bit: BitNumber) -> i32, at 0x1001_2214, cost 78, header,
                polls(PolledState::Bit), reads_bit;
            /// Analog input `ch` in counts, -2048 to 2047, as the macro ADC(ch) gives it.
            io::read_adc = ReadADC(ch: i32) -> i32, at 0x8001_C3E0, cost 19, header;
            /// Drives PWM channel `ch` in locked antiphase, `v` within ±MAX_PWM_VALUE.
            io::write_pwm = WritePWM(ch: i32, v: BoundedInt<MAX_PWM_VALUE>), at 0x1000_1CB4, cost 101, header;
            /// Drives PWM channel `ch` in recirculate mode, `v` within ±MAX_PWMR_VALUE.
            io::write_pwmr = WritePWMR(ch: i32, v: BoundedInt<MAX_PWMR_VALUE>), at 0x1000_1B24, cost 97, header;
            /// Commands the current loop of PWM channel `ch` (SnapAmp), `v` within ±MAX_PWMC_VALUE.
            io::write_pwmc = WritePWMC(ch: i32, v: BoundedInt<MAX_PWMC_VALUE>), at 0x1000_1BD8, cost 17, header;

            // ---- motion: single axes: enabling, independent moves, commutation ------------------------
            /// Turns an axis on where it is: the destination becomes the measured position.
            motion::enable_axis = EnableAxis(ch: AxisNumber), at 0x8001_1258, cost 241, header, drives_axis;
            /// Turns an axis on with destination `Dest` in position units, filters reset, no profile
            /// running.
            motion::enable_axis_dest = EnableAxisDest(ch: AxisNumber, Dest: f64), at 0x8001_0E80, cost 198, header,
                drives_axis;
            /// Turns an axis off: feedback stops, the output goes to zero.
            motion::disable_axis = DisableAxis(ch: AxisNumber), at 0x1000_EA30, cost 221, header;
            /// Makes the present place zero: measured position and destination become 0.
            motion::zero = Zero(ch: AxisNumber), at 0x8001_0B14, cost 542, header;
            /// Clears the filter delays, integrator and output of an axis; use before enabling or after new
            /// coefficients.
            motion::reset_filters = ResetFilters(ch: AxisNumber), at 0x8001_1300, cost 63, header;
            /// Starts a move to position `x` under the axis' Vel, Accel and Jerk. Poll CheckDone.
            motion::move_to = Move(ch: AxisNumber, x: f64), at 0x1000_C15C, cost 3420, header,
                drives_axis;
            /// Starts a move by `dx` from the present destination. Poll CheckDone.
            motion::move_rel = MoveRel(ch: AxisNumber, dx: f64), at 0x1000_C1B0, cost 3423, header,
                drives_axis;
            /// Starts a move to position `x` with at most `MaxVel` units/s. Poll CheckDone.
            motion::move_at_vel = MoveAtVel(chno: AxisNumber, x: f64, MaxVel: f32), at 0x1000_B868, cost 3420, header,
                drives_axis;
            /// Starts a move by `x` from the present destination with at most `MaxVel` units/s.
            motion::move_rel_at_vel = MoveRelAtVel(chno: AxisNumber, x: f64, MaxVel: f32),
                at 0x1000_C104, cost 3450, header, drives_axis;
            /// Starts an exponential approach to `x` with time constant `Tau` seconds.
            motion::move_exp = MoveExp(chno: AxisNumber, x: f64, Tau: f64), at 0x1000_C208, cost 475, header,
                drives_axis;
            /// Runs an axis at `vel` units/s, signed; 0 brings it to a stop under Accel and Jerk.
            motion::jog = Jog(ch: AxisNumber, vel: f64), at 0x1000_C558, cost 1418, header,
                drives_axis;
            /// Starts independent moves of the coordinate system's six axes. Poll CheckDoneXYZABC.
            motion::move_xyzabc = MoveXYZABC(x: f64, y: f64, z: f64, a: f64, b: f64, c: f64),
                at 0x8001_020C, cost 10426, header;
            /// 1 when no profile is running, 0 while one is, -1 when the axis is disabled.
            motion::check_done = CheckDone(ch: AxisNumber) -> i32, at 0x1000_CA74, cost 25, header,
                polls(PolledState::Motion);
            /// CheckDone over all axes of the coordinate system: 1 all finished, 0 some moving, -1 one
            /// disabled.
            motion::check_done_xyzabc = CheckDoneXYZABC() -> i32, at 0x1000_CAC8, cost 313, header,
                polls(PolledState::Path);
            /// Starts the profile prepared in the coefficient list of axis `ch`.
            motion::start_move = StartMove(ch: AxisNumber), at 0x8002_13F4, cost 22, header, drives_axis;
            /// Drops the running profile; the destination stays where it is.
            motion::stop_motion = StopMotion(ch: *mut Chan), at 0x8002_12E0, cost 8, header;
            /// Computes the profile From..To with at most `MaxVel` into the list of `ch` from entry
            /// `CoeffOffset` on; stores the number of states in `*Nstates`.
            motion::setup_for_move = SetupForMove(
                From: f64, To: f64, MaxVel: f32, ch: *mut Chan, CoeffOffset: i32,
                NoJerkControlAtStart: i32, NoJerkControlAtEnd: i32, Start: i32, Nstates: *mut i32
            ), at 0x1000_8A60, cost 3844, header;
            /// Puts a hold at `x` for `time` seconds into entry `CoeffOffset` of the list of `ch`.
            motion::setup_for_motion_pause = SetupForMotionPause(
                x: f64, ch: *mut Chan, CoeffOffset: i32, time: f64
            ), at 0x8002_16C8, cost 28, header;
            /// Puts the end of motion into entry `CoeffOffset` of the list of `ch`.
            motion::setup_for_motion_end = SetupForMotionEnd(ch: *mut Chan, CoeffOffset: i32),
                at 0x8002_172C, cost 15, header;
            /// Applies a vector of `v` PWM counts at a commutation angle in cycles to the three-phase
            /// outputs of an axis.
            motion::write_3ph = Write3PH(ch0: *mut Chan, v: f32, angle_in_cycles: f64),
                at 0x1000_22CC, cost 326, header;
            /// Applies a vector of `v` PWM counts at a commutation angle in cycles to the four-phase
            /// outputs of an axis.
            motion::write_4ph = Write4PH(ch0: *mut Chan, v: f32, angle_in_cycles: f64),
                at 0x1000_1D60, cost 348, header;
            /// Computes the resolver angle from sine and cosine readings and updates the axis' Position.
            motion::do_resolver_input2 = DoResolverInput2(chx: *mut Chan, x: f32, y: f32),
                at 0x1000_5C80, cost 166, header;

            // ---- coord: coordinated motion: coordinate system, feed override, feedhold ---------------
            /// Assigns the axes used as x, y, z, a; -1 leaves one unused. b, c, u, v keep theirs.
            coord::define_coord_system = DefineCoordSystem(axisx: i32, axisy: i32, axisz: i32, axisa: i32),
                at 0x8002_5920, cost 43, header;
            /// Assigns the axes used as x, y, z, a, b, c; -1 leaves one unused. u, v keep theirs.
            coord::define_coord_system6 = DefineCoordSystem6(
                axisx: i32, axisy: i32, axisz: i32, axisa: i32, axisb: i32, axisc: i32
            ), at 0x8002_59A8, cost 61, header;
            /// Assigns the axes used as x, y, z, a, b, c, u, v; -1 leaves one unused.
            coord::define_coord_system8 = DefineCoordSystem8(
                axisx: i32, axisy: i32, axisz: i32, axisa: i32, axisb: i32, axisc: i32, axisu: i32,
                axisv: i32
            ), at 0x8002_5A74, cost 79, header;
            /// Buffered motion: 1 finished, 0 running, -1 an axis of the coordinate system is disabled.
            coord::check_done_buf = CheckDoneBuf() -> i32, at 0x1000_CDAC, cost 206, header,
                polls(PolledState::Path);
            /// Feedhold: brings the coordinate system's axes to a controlled stop. See CS0_StoppingState.
            coord::stop_coordinated_motion = StopCoordinatedMotion(), at 0x8001_C6C4, cost 340, header;
            /// Releases a feedhold and continues the interrupted motion.
            coord::resume_coordinated_motion = ResumeCoordinatedMotion(), at 0x1000_3904, cost 37, header;
            /// Drops the feedhold without continuing the interrupted motion.
            coord::clear_stop_immediately = ClearStopImmediately(), at 0x8001_DB78, cost 15, header;
            /// Recomputes CS0_StoppingState; needed only while independent moves are being stopped.
            coord::update_stopping_state = UpdateStoppingState(), at 0x8001_D464, cost 61, header;
            /// Seconds from full override to standstill, from the limits of all axes in the coordinate
            /// system.
            coord::get_nominal_fro_change_time = GetNominalFROChangeTime() -> f32,
                at 0x1000_31F8, cost 838, header;
            /// Empties the buffer of coordinated motion and prepares it for new segments, as the command OpenBuf does.
            coord::open_buf = iOpenBuf(), at 0x8001_3F6C, cost 68, firmware;
            /// Starts the buffer of coordinated motion, as the command ExecBuf does.
            coord::exec_buf = iExecBuf(), at 0x8001_4050, cost 1072, firmware;
            /// Ramps the feed override to `FRO` (1.0 real time, 0 stopped, negative backwards).
            coord::set_fro = SetFRO(FRO: f32), at 0x1000_3610, cost 1001, header;
            /// Ramps the rapid override to `FRO`.
            coord::set_rapid_fro = SetRapidFRO(FRO: f32), at 0x1000_33A0, cost 987, header;
            /// Ramps the feed override even during a feedhold and does not keep the value for the resume.
            coord::set_fro_temp = SetFROTemp(FRO: f32), at 0x1000_35B4, cost 987, header;
            /// SetFRO with `DecelTime` seconds for the whole way from 1.0 to 0.0.
            coord::set_fro_w_rate = SetFROwRate(FRO: f32, DecelTime: f32), at 0x1000_34B0, cost 138, header;
            /// SetRapidFRO with `DecelTime` seconds for the whole way from 1.0 to 0.0.
            coord::set_rapid_fro_w_rate = SetRapidFROwRate(FRO: f32, DecelTime: f32),
                at 0x1000_3100, cost 124, header;
            /// SetFROTemp with `DecelTime` seconds for the whole way from 1.0 to 0.0.
            coord::set_fro_w_rate_temp = SetFROwRateTemp(FRO: f32, DecelTime: f32),
                at 0x1000_33FC, cost 124, header;
            /// Call after writing `ParametricCoeffs[ParametricIndex]`: advances the index and accounts for
            /// the time.
            coord::inc_parametric_index = IncParametricIndex(), at 0x8001_3D08, cost 77, header;

            // ---- spindle: spindle measurement and threading -------------------------------------------
            /// Sets up spindle measurement: `Type` 0 none, 1 encoder; `Axis` the channel read; update time
            /// and `Tau` in seconds.
            spindle::configure_spindle = ConfigureSpindle(
                Type: i32, Axis: AxisNumber, UpdateTimeSecs: f32, Tau: f32, CountsPerRev: f32
            ), at 0x8001_D948, cost 441, header;
            /// Starts buffered motion slaved to the spindle, planned for `BaseSpeedRPS` revolutions/s.
            spindle::trig_threading = TrigThreading(BaseSpeedRPS: f32), at 0x1000_2760, cost 88, header;

            // ---- time: time and waiting ---------------------------------------------------------------
            /// Seconds since power-up.
            time::time_sec = Time_sec() -> f64, at 0x1001_3400, cost 80, header, polls(PolledState::Time);
            /// Waits until Time_sec() reaches `time_sec`; other threads keep running.
            time::wait_until = WaitUntil(time_sec: f64), at 0x1000_26C4, cost 106, header,
                waits("until that time"), polls(PolledState::Time), after_time(63, 1);
            /// Waits `sec` seconds; other threads keep running.
            time::delay_sec = Delay_sec(sec: f64), at 0x1000_748C, cost 201, header,
                waits("until the time has passed"), polls(PolledState::Time), after_time(63, 1);
            /// Waits for the thread's next time slice and returns the time in seconds.
            time::wait_next_time_slice = WaitNextTimeSlice() -> f64, at 0x1000_1180, cost 113, header,
                waits("until the next slice of the thread"), polls(PolledState::Time), after_slice(69, 1);

            // ---- thread: starting and stopping threads ------------------------------------------------
            /// Starts, or starts again, the program loaded for user thread 1 to 7.
            thread::start_thread = StartThread(thread: ThreadNumber), at 0x8002_50E0, cost 116, header;
            /// Stops scheduling user thread 1 to 7; a thread may name itself.
            thread::pause_thread = PauseThread(thread: ThreadNumber), at 0x8002_5218, cost 89, header;
            /// Continues a paused thread where it stopped; 1 if no program is loaded there, else 0.
            thread::resume_thread = ResumeThread(thread: ThreadNumber) -> i32, at 0x8002_52B8, cost 38, header;
            /// Ends the calling thread, as a return from main does. Does not return.
            thread::thread_done = ThreadDone(), at 0x8002_51D4, cost 200, header;

            // ---- sync: locks and uninterruptible operations -------------------------------------------
            /// Takes `*mutex` for the calling thread; waits while another thread holds it.
            sync::mutex_lock = MutexLock(mutex: *mut i32), at 0x1001_2F20, cost 38, header,
                waits("while another thread holds the lock"), polls(PolledState::Lock);
            /// Stores 0 in `*mutex`, whoever holds it.
            sync::mutex_unlock = MutexUnlock(mutex: *mut i32), at 0x1001_302C, cost 15, header;
            /// `*p |= mask`, uninterruptible.
            sync::atomic_set = AtomicSet(p: *mut i32, mask: i32), at 0x1001_2C90, cost 7, header;
            /// `*p &= mask`, uninterruptible: the mask has ones at the bits to keep.
            sync::atomic_clear = AtomicClear(p: *mut i32, mask: i32), at 0x1001_2CA8, cost 7, header;
            /// Stores `value` if `*mutex` is 0; returns what was there (0: acquired). Uninterruptible.
            sync::test_and_set = TestAndSet(mutex: *mut i32, value: i32) -> i32,
                at 0x1001_2A40, cost 6, header;

            // ---- console: text to the console of the PC and to files on it ----------------------------
            /// Formats up to 128 characters for the console; returns the full length. Waits only while the
            /// queue is full.
            console::printf = printf(format: PrintFormat; varargs) -> i32, at 0x8001_EA40, cost 367, header,
                waits("while the console queue is full"), stack(945);
            /// Formats into `s`, without a limit; returns the length.
            console::sprintf = sprintf(s: *mut Char, format: PrintFormat; varargs) -> i32,
                at 0x8002_6FC0, cost 83, header, stack(840);
            /// Converts the text of `_str` under a format; returns the number of items converted.
            console::sscanf = sscanf(_str: *const Char, _fmt: ScanFormat; varargs) -> i32,
                at 0x8002_5FC0, cost 560, header;
            /// Queues a string for the console, line by line. Returns 0. Waits only while the queue is
            /// full.
            console::print = Print(s: *mut Char) -> i32, at 0x1001_2510, cost 100, header,
                waits("while the console queue is full");
            /// Formats one double for the console. Returns 0.
            console::print_float = PrintFloat(Format: PrintFormat<*mut Char>, v: f64) -> i32,
                at 0x8001_F3F0, cost 367, header, waits("while the console queue is full");
            /// Formats one int for the console. Returns 0.
            console::print_int = PrintInt(Format: PrintFormat<*mut Char>, v: i32) -> i32, at 0x8001_F474, cost 367, header,
                waits("while the console queue is full");
            /// Opens a text file on the PC ("rt", "wt", "at"). Reading waits for the PC and gives NULL on
            /// failure; one file each way.
            console::fopen = fopen(path: FileName, mode: *const Char) -> *mut File,
                at 0x8001_EB74, cost 1152, header,
                waits("until the PC has opened the file, if it is for reading");
            /// Closes a file on the PC. Returns 0.
            console::fclose = fclose(f: *mut File) -> i32, at 0x8001_F358, cost 821, header,
                waits("while the console queue is full");
            /// Formats up to 128 characters for a file on the PC. Returns 0.
            console::fprintf = fprintf(f: *mut File, format: PrintFormat; varargs) -> i32,
                at 0x8001_EAD4, cost 770, header, waits("while the console queue is full");
            /// Reads the next line, at most `n` characters, without its end. Waits for the PC; NULL at the
            /// end of the file.
            console::fgets = fgets(str: *mut Char, n: i32, file: *mut File) -> *mut Char,
                at 0x8001_EDD0, cost 880, header, waits("until the PC has sent the line");
            /// Reads a line of at most 128 characters and converts it; returns the number of items. Waits
            /// for the PC.
            console::fscanf = fscanf(f: *mut File, format: ScanFormat; varargs) -> i32,
                at 0x8001_F20C, cost 1700, header, waits("until the PC has sent the line");
            /// 1 after a read or an opening has failed, else 0.
            console::feof = feof(f: *mut File) -> i32, at 0x8001_F2D8, cost 52, header;
            /// Formats at most `_n` characters from the argument area at `_ap`.
            console::vsnprintf = vsnprintf(
                _string: *mut Char, _n: SizeT, _format: PrintFormat, _ap: *mut Char
            ) -> i32, at 0x8002_68E0, cost 84, firmware;
            /// Formats at most `n` characters into `s`; returns the full length.
            console::snprintf = snprintf(s: *mut Char, n: SizeT, format: PrintFormat; varargs) -> i32,
                at 0x7000_0000, cost 84, library;
            /// Formats into `s` from the argument area at `ap`.
            console::vsprintf = vsprintf(s: *mut Char, format: PrintFormat, ap: *mut Char) -> i32,
                at 0x7000_0008, cost 84, library;
            /// Formats for the console from the argument area at `ap`.
            console::vprintf = vprintf(format: PrintFormat, ap: *mut Char) -> i32,
                at 0x7000_0010, cost 367, library, waits("while the console queue is full");
            /// Sends a string and a newline to the console.
            console::puts = puts(s: *const Char) -> i32, at 0x7000_0018, cost 367, library,
                waits("while the console queue is full");
            /// Sends one character to the console.
            console::putchar = putchar(c: i32) -> i32, at 0x7000_0020, cost 367, library,
                waits("while the console queue is full");

            // ---- gather: the data recorder ------------------------------------------------------------
            /// Prepares recording of six doubles a tick of axis `c` for `n_Samples` ticks; TriggerGather
            /// starts it.
            gather::setup_gather_all_on_axis = SetupGatherAllOnAxis(c: AxisNumber, n_Samples: i32),
                at 0x8002_1440, cost 102, header;
            /// Starts recording into gather_buffer. Poll CheckDoneGather.
            gather::trigger_gather = TriggerGather(), at 0x8002_12A0, cost 14, header;
            /// 1 when recording has reached its end, else 0.
            gather::check_done_gather = CheckDoneGather() -> i32, at 0x8002_1950, cost 16, header,
                polls(PolledState::Recording);

            // ---- serial: the UART ---------------------------------------------------------------------
            /// Enables the UART pins and sets the divisor, one of the RS232_BAUD_ values. Takes about 2 ms.
            serial::init_rs232 = InitRS232(baud: i32), at 0x8002_1760, cost 451, header,
                waits("about 2 ms for the UART");
            /// InitRS232, then empties both rings and connects the command interpreter (DoRS232Cmds = 1).
            /// Takes about 2 ms.
            serial::enable_rs232_cmds = EnableRS232Cmds(baud: i32), at 0x8002_18C8, cost 490, header,
                waits("about 2 ms for the UART");
            /// Takes the next received character; waits while there is none.
            serial::rs232_get_char = RS232_GetChar() -> Char, at 0x1000_1254, cost 200, header,
                waits("while no character has been received");
            /// Sends a character; waits while the transmit ring is full.
            serial::rs232_put_char = RS232_PutChar(c: Char), at 0x1000_12C0, cost 67, header,
                waits("while the transmit ring is full");

            // ---- snapamp: registers of the SnapAmp option board ---------------------------------------
            /// Writes a 16-bit word to SnapAmp register `add` (SNAP0 or SNAP1 plus a SNAP_ number).
            snapamp::write_snap_amp = WriteSnapAmp(add: i32, data: i32), at 0x1000_1AD0, cost 207, header;
            /// Reads a 16-bit word from SnapAmp register `add` (SNAP0 or SNAP1 plus a SNAP_ number).
            snapamp::read_snap_amp = ReadSnapAmp(add: i32) -> i32, at 0x1001_2BA0, cost 150, header;

            // ---- konnect: konnect option boards on the AUX ports --------------------------------------
            /// Prepares the AUX port for Konnect boards and empties the list of boards served.
            konnect::init_aux = InitAux(), at 0x8001_D908, cost 6, header;
            /// Serves a Konnect board on AUX1 from now on: 16 outputs from `*OutputAddress`, 32 inputs to
            /// `*InputAddress`.
            konnect::add_konnect = AddKonnect(
                BoardAddress: i32, OutputAddress: *mut i32, InputAddress: *mut i32
            ), at 0x8001_DBE8, cost 33, header;
            /// AddKonnect for a board on AUX0.
            konnect::add_konnect_aux0 = AddKonnect_Aux0(
                BoardAddress: i32, OutputAddress: *mut i32, InputAddress: *mut i32
            ), at 0x1000_7F40, cost 33, header;

            // ---- persist: flash memory ----------------------------------------------------------------
            /// Erases and writes `Length` 16-bit words of flash, printing progress after `message`. Waits;
            /// 0 = success.
            persist::program_flash = ProgramFlash(
                src: *mut Volatile<Char>, Length: i32, dest: *mut Volatile<Char>, message: *mut Char
            ) -> i32, at 0x8001_FFC0, cost 56031, header, waits("until the flash is written");
            /// ProgramFlash without console output. Waits; 0 = success.
            persist::program_flash_no_messages = ProgramFlashNoMessages(
                src0: *mut Volatile<Char>, Length: i32, dest0: *mut Volatile<Char>
            ) -> i32, at 0x8002_0008, cost 33333, header, waits("until the flash is written");
            /// Selects the flash bank that makes address `add` readable.
            persist::set_flash_bank = SetFlashBank(add: *mut Volatile<u16>), at 0x1001_2CC0, cost 217, header;

            // ---- math: mathematics. Angles are in radians unless cycles are named ---------------------
            /// Square root.
            math::sqrt = sqrt(x: f64) -> f64, at 0x8002_5B80, cost 379, header,
                pure, changes(ALL, &[0, 4, 5, 6, 7]);
            /// e to the power `x`.
            math::exp = exp(x: f64) -> f64, at 0x1000_F000, cost 214, header, pure;
            /// Natural logarithm.
            math::log = log(x: f64) -> f64, at 0x1000_F424, cost 283, header, pure;
            /// Logarithm to base 10.
            math::log10 = log10(x: f64) -> f64, at 0x1000_F3A4, cost 284, header, pure;
            /// `x` to the power `y`.
            math::pow = pow(x: f64, y: f64) -> f64, at 0x8002_0940, cost 1100, header, pure;
            /// Sine.
            math::sin = sin(x: f64) -> f64, at 0x1000_FABC, cost 144, header,
                pure, changes(ALL, NOT_B3), returns_early;
            /// Cosine.
            math::cos = cos(x: f64) -> f64, at 0x1000_FAA0, cost 148, header,
                pure, changes(ALL, NOT_B3), returns_early;
            /// Tangent.
            math::tan = tan(x: f64) -> f64, at 0x8002_4360, cost 440, header, pure, changes(ALL, NOT_B3);
            /// Arc sine.
            math::asin = asin(x: f64) -> f64, at 0x8002_3F80, cost 256, header,
                pure, changes(ALL, &[0, 2, 4, 5, 6, 7, 8, 9]);
            /// Arc cosine.
            math::acos = acos(x: f64) -> f64, at 0x8002_3760, cost 271, header,
                pure, changes(ALL, &[0, 2, 4, 5, 6, 7, 8, 9]);
            /// Arc tangent.
            math::atan = atan(x: f64) -> f64, at 0x8002_5680, cost 335, header,
                pure, changes(ALL, &[0, 2, 4, 5, 6, 7, 8, 9]);
            /// Arc tangent of `y / x` in all four quadrants.
            math::atan2 = atan2(y: f64, x: f64) -> f64, at 0x8002_6D20, cost 565, header,
                pure, changes(ALL, &[0, 2, 4, 5, 6, 7, 8, 9]);
            /// Absolute value.
            math::fast_fabs = fast_fabs(y: f64) -> f64, at 0x1000_1A3C, cost 6, header, pure;
            /// Square root.
            math::sqrtf = sqrtf(x: f32) -> f32, at 0x1000_F820, cost 41, header,
                pure, changes(&[0, 1, 2, 3, 4, 5], &[4, 5, 6]);
            /// e to the power `x`.
            math::expf = expf(x: f32) -> f32, at 0x1000_F1F4, cost 72, header, pure;
            /// Natural logarithm.
            math::logf = logf(x: f32) -> f32, at 0x1000_F640, cost 66, header, pure;
            /// Logarithm to base 10.
            math::log10f = log10f(x: f32) -> f32, at 0x1000_F620, cost 67, header, pure;
            /// `x` to the power `y`.
            math::powf = powf(x: f32, y: f32) -> f32, at 0x8002_1980, cost 680, header, pure;
            /// Sine.
            math::sinf = sinf(x: f32) -> f32, at 0x1000_FC34, cost 62, header, pure, changes(ALL, NOT_B3);
            /// Cosine.
            math::cosf = cosf(x: f32) -> f32, at 0x1000_FC20, cost 66, header, pure, changes(ALL, NOT_B3);
            /// Tangent.
            math::tanf = tanf(x: f32) -> f32, at 0x8002_53C0, cost 233, header, pure, changes(ALL, NOT_B3);
            /// Arc sine.
            math::asinf = asinf(x: f32) -> f32, at 0x8002_6580, cost 120, header, pure, changes(ALL, NOT_B3);
            /// Arc cosine.
            math::acosf = acosf(x: f32) -> f32, at 0x8002_63A0, cost 117, header, pure, changes(ALL, NOT_B3);
            /// Arc tangent.
            math::atanf = atanf(x: f32) -> f32, at 0x1000_F974, cost 54, header, pure, changes(ALL, NOT_B3);
            /// Arc tangent of `y / x` in all four quadrants.
            math::atan2f = atan2f(y: f32, x: f32) -> f32, at 0x1000_F8C0, cost 80, header,
                pure, changes(ALL, NOT_B3);
            /// Absolute value.
            math::fast_fabsf = fast_fabsf(y: f32) -> f32, at 0x1000_1A30, cost 6, header, pure;
            /// Sine of `x` cycles, 0 to 1; the second phase's sine goes to `*sin2`.
            math::sine_3ph = Sine3PH(x: f32, sin2: *mut f32) -> f32, at 0x1001_3180, cost 27, firmware;
            /// Real cube root, of negative numbers too.
            math::cube_root = CubeRoot(v: f64) -> f64, at 0x1000_89AC, cost 580, firmware;
            /// Fractional part of `v`, with its sign.
            math::fractionf = fractionf(v: f64) -> f32, at 0x1000_1970, cost 41, firmware;
            /// Fractional part of `x`; the whole part goes to `*ip`.
            math::modf = modf(x: f64, ip: *mut f64) -> f64, at 0x8002_7B40, cost 50, firmware;
            /// Fractional part of `x`; the whole part goes to `*ip`.
            math::modff = modff(x: f32, ip: *mut f32) -> f32, at 0x8002_7CA0, cost 37, firmware;
            /// 2 to the power `x`.
            math::exp2 = exp2(x: f64) -> f64, at 0x1000_EFC0, cost 227, firmware, pure;
            /// 2 to the power `x`.
            math::exp2f = exp2f(x: f32) -> f32, at 0x1000_F188, cost 73, firmware, pure;
            /// 10 to the power `x`.
            math::exp10 = exp10(x: f64) -> f64, at 0x1000_EFE4, cost 227, firmware, pure;
            /// 10 to the power `x`.
            math::exp10f = exp10f(x: f32) -> f32, at 0x1000_F1C0, cost 73, firmware, pure;
            /// Logarithm to base 2.
            math::log2 = log2(x: f64) -> f64, at 0x1000_F320, cost 284, firmware, pure;
            /// Logarithm to base 2.
            math::log2f = log2f(x: f32) -> f32, at 0x1000_F600, cost 67, firmware, pure;
            /// Splits `x` into a fraction in [0.5, 1) and a power of two.
            math::frexp = frexp(x: f64, exp: *mut i32) -> f64, at 0x8002_7440, cost 29, firmware;
            /// Splits `x` into a fraction in [0.5, 1) and a power of two.
            math::frexpf = frexpf(x: f32, exp: *mut i32) -> f32, at 0x8002_7740, cost 27, firmware;
            /// `x` times 2 to the power `n`.
            math::ldexp = ldexp(x: f64, n: i32) -> f64, at 0x8002_6A60, cost 46, firmware;
            /// `x` times 2 to the power `n`.
            math::ldexpf = ldexpf(x: f32, n: i32) -> f32, at 0x8002_7320, cost 41, firmware;
            /// Signed quotient, as code of the vendor's compiler calls it.
            math::divi = _divi(a: i32, b: i32) -> i32, at 0x8002_70E0, cost 22, firmware,
                changes(&[0, 1, 2, 4, 6], &[0, 1, 2, 4, 5]);
            /// Unsigned quotient, as code of the vendor's compiler calls it.
            math::divu = _divu(a: u32, b: u32) -> u32, at 0x8002_7900, cost 22, firmware,
                changes(&[0, 1, 2, 4, 6], &[0, 1, 2, 4]);
            /// Signed remainder, as code of the vendor's compiler calls it.
            math::remi = _remi(a: i32, b: i32) -> i32, at 0x8002_7560, cost 20, firmware,
                changes(&[1, 2, 4, 5, 6], &[0, 1, 2, 4]);
            /// Unsigned remainder, as code of the vendor's compiler calls it.
            math::remu = _remu(a: u32, b: u32) -> u32, at 0x8002_7C00, cost 22, firmware,
                changes(&[1, 4, 5, 7], &[0, 1, 2, 4]);
            /// Quotient of floats, as code of the vendor's compiler calls it.
            math::divf = _divf(a: f32, b: f32) -> f32, at 0x1000_EF60, cost 30, firmware,
                changes(&[3, 4], &[0, 5, 6]);
            /// Quotient of doubles, as code of the vendor's compiler calls it.
            math::divd = _divd(a: f64, b: f64) -> f64, at 0x1000_F7A0, cost 84, firmware,
                changes(&[4, 5, 6, 7], &[2, 6, 7, 8, 9]);
            /// Absolute value.
            math::fabs = fabs(x: f64) -> f64, at 0x7000_0028, cost 200, library, pure;
            /// Absolute value.
            math::fabsf = fabsf(x: f32) -> f32, at 0x7000_0030, cost 200, library, pure;
            /// Largest whole number not above `x`.
            math::floor = floor(x: f64) -> f64, at 0x7000_0038, cost 200, library, pure;
            /// Largest whole number not above `x`.
            math::floorf = floorf(x: f32) -> f32, at 0x7000_0040, cost 200, library, pure;
            /// Smallest whole number not below `x`.
            math::ceil = ceil(x: f64) -> f64, at 0x7000_0048, cost 200, library, pure;
            /// Smallest whole number not below `x`.
            math::ceilf = ceilf(x: f32) -> f32, at 0x7000_0050, cost 200, library, pure;
            /// Remainder of `x / y` with the sign of `x`.
            math::fmod = fmod(x: f64, y: f64) -> f64, at 0x7000_0058, cost 200, library, pure;
            /// Remainder of `x / y` with the sign of `x`.
            math::fmodf = fmodf(x: f32, y: f32) -> f32, at 0x7000_0060, cost 200, library, pure;
            /// Nearest whole number, halves away from zero.
            math::round = round(x: f64) -> f64, at 0x7000_0068, cost 200, library, pure;
            /// Nearest whole number, halves away from zero.
            math::roundf = roundf(x: f32) -> f32, at 0x7000_0070, cost 200, library, pure;
            /// Whole part.
            math::trunc = trunc(x: f64) -> f64, at 0x7000_0078, cost 200, library, pure;
            /// Whole part.
            math::truncf = truncf(x: f32) -> f32, at 0x7000_0080, cost 200, library, pure;
            /// Hyperbolic sine.
            math::sinh = sinh(x: f64) -> f64, at 0x7000_0088, cost 200, library, pure;
            /// Hyperbolic sine.
            math::sinhf = sinhf(x: f32) -> f32, at 0x7000_0090, cost 200, library, pure;
            /// Hyperbolic cosine.
            math::cosh = cosh(x: f64) -> f64, at 0x7000_0098, cost 200, library, pure;
            /// Hyperbolic cosine.
            math::coshf = coshf(x: f32) -> f32, at 0x7000_00A0, cost 200, library, pure;
            /// Hyperbolic tangent.
            math::tanh = tanh(x: f64) -> f64, at 0x7000_00A8, cost 200, library, pure;
            /// Hyperbolic tangent.
            math::tanhf = tanhf(x: f32) -> f32, at 0x7000_00B0, cost 200, library, pure;
            /// Square root of `x² + y²`.
            math::hypot = hypot(x: f64, y: f64) -> f64, at 0x7000_00B8, cost 200, library, pure;
            /// Square root of `x² + y²`.
            math::hypotf = hypotf(x: f32, y: f32) -> f32, at 0x7000_00C0, cost 200, library, pure;
            /// Reciprocal of the square root.
            math::rsqrt = rsqrt(x: f64) -> f64, at 0x7000_00C8, cost 200, library, pure;
            /// Reciprocal of the square root.
            math::rsqrtf = rsqrtf(x: f32) -> f32, at 0x7000_00D0, cost 200, library, pure;

            // ---- string: strings, blocks of memory, characters ----------------------------------------
            /// Copies `n` bytes; returns `dst`.
            string::memcpy = memcpy(dst: *mut Void, src: *const Void, n: SizeT) -> *mut Void,
                at 0x1000_1844, cost 32, firmware, changes(ALL, &[0, 1, 2, 4, 5]);
            /// Fills `len` bytes; returns `dst`.
            string::memset = memset(dst: *mut Void, fill: i32, len: SizeT) -> *mut Void,
                at 0x8002_7820, cost 41, firmware, changes(&[0, 1, 2, 3, 4, 5, 6, 7], &[0, 1, 2, 4]);
            /// Copies until `ch` has been copied or `cnt` bytes are done.
            string::memccpy = memccpy(dest: *mut Char, src: *const Char, ch: i32, cnt: i32) -> *mut Char,
                at 0x8002_7DA0, cost 20, firmware;
            /// Length without the terminator.
            string::strlen = strlen(string: *const Char) -> SizeT, at 0x8002_7EC0, cost 19, firmware;
            /// First place of `string2` in `string1`, or NULL.
            string::strstr = strstr(string1: *const Char, string2: *const Char) -> *mut Char,
                at 0x8002_7D20, cost 100, firmware;
            /// Nonzero for white space.
            string::isspace = isspace(c: i32) -> i32, at 0x8002_7F00, cost 14, firmware;
            /// Copies a string; returns `dst`.
            string::strcpy = strcpy(dst: *mut Char, src: *const Char) -> *mut Char,
                at 0x7000_00D8, cost 200, library;
            /// Copies at most `n` characters and fills the rest with zeros.
            string::strncpy = strncpy(dst: *mut Char, src: *const Char, n: SizeT) -> *mut Char,
                at 0x7000_00E0, cost 200, library;
            /// Appends a string; returns `dst`.
            string::strcat = strcat(dst: *mut Char, src: *const Char) -> *mut Char,
                at 0x7000_00E8, cost 200, library;
            /// Appends at most `n` characters and a terminator.
            string::strncat = strncat(dst: *mut Char, src: *const Char, n: SizeT) -> *mut Char,
                at 0x7000_00F0, cost 200, library;
            /// Compares two strings: negative, 0 or positive.
            string::strcmp = strcmp(a: *const Char, b: *const Char) -> i32, at 0x7000_00F8, cost 200, library;
            /// Compares at most `n` characters.
            string::strncmp = strncmp(a: *const Char, b: *const Char, n: SizeT) -> i32,
                at 0x7000_0100, cost 200, library;
            /// First place of `c`, or NULL.
            string::strchr = strchr(s: *const Char, c: i32) -> *mut Char, at 0x7000_0108, cost 200, library;
            /// Last place of `c`, or NULL.
            string::strrchr = strrchr(s: *const Char, c: i32) -> *mut Char, at 0x7000_0110, cost 200, library;
            /// Length of the start made of characters of `set`.
            string::strspn = strspn(s: *const Char, set: *const Char) -> SizeT,
                at 0x7000_0118, cost 200, library;
            /// Length of the start without characters of `set`.
            string::strcspn = strcspn(s: *const Char, set: *const Char) -> SizeT,
                at 0x7000_0120, cost 200, library;
            /// First place of any character of `set`, or NULL.
            string::strpbrk = strpbrk(s: *const Char, set: *const Char) -> *mut Char,
                at 0x7000_0128, cost 200, library;
            /// Next token of `s`, or of the last string if NULL.
            string::strtok = strtok(s: *mut Char, separators: *const Char) -> *mut Char,
                at 0x7000_0130, cost 200, library;
            /// Copies `n` bytes that may overlap; returns `dst`.
            string::memmove = memmove(dst: *mut Void, src: *const Void, n: SizeT) -> *mut Void,
                at 0x7000_0138, cost 200, library;
            /// Compares `n` bytes: negative, 0 or positive.
            string::memcmp = memcmp(a: *const Void, b: *const Void, n: SizeT) -> i32,
                at 0x7000_0140, cost 200, library;
            /// First place of the byte `c`, or NULL.
            string::memchr = memchr(s: *const Void, c: i32, n: SizeT) -> *mut Void,
                at 0x7000_0148, cost 200, library;
            /// The upper-case letter of a letter.
            string::toupper = toupper(c: i32) -> i32, at 0x7000_0150, cost 200, library;
            /// The lower-case letter of a letter.
            string::tolower = tolower(c: i32) -> i32, at 0x7000_0158, cost 200, library;
            /// Nonzero for 0 to 9.
            string::isdigit = isdigit(c: i32) -> i32, at 0x7000_0160, cost 200, library;
            /// Nonzero for letters.
            string::isalpha = isalpha(c: i32) -> i32, at 0x7000_0168, cost 200, library;
            /// Nonzero for letters and digits.
            string::isalnum = isalnum(c: i32) -> i32, at 0x7000_0170, cost 200, library;
            /// Nonzero for upper-case letters.
            string::isupper = isupper(c: i32) -> i32, at 0x7000_0178, cost 200, library;
            /// Nonzero for lower-case letters.
            string::islower = islower(c: i32) -> i32, at 0x7000_0180, cost 200, library;
            /// Nonzero for hexadecimal digits.
            string::isxdigit = isxdigit(c: i32) -> i32, at 0x7000_0188, cost 200, library;
            /// Nonzero for printing characters that are neither space, letter nor digit.
            string::ispunct = ispunct(c: i32) -> i32, at 0x7000_0190, cost 200, library;
            /// Nonzero for printing characters, the space among them.
            string::isprint = isprint(c: i32) -> i32, at 0x7000_0198, cost 200, library;
            /// Nonzero for control characters.
            string::iscntrl = iscntrl(c: i32) -> i32, at 0x7000_01A0, cost 200, library;
            /// Nonzero for printing characters, without the space.
            string::isgraph = isgraph(c: i32) -> i32, at 0x7000_01A8, cost 200, library;

            // ---- stdlib: the rest of the C library: heap, numbers, sorting, ending --------------------
            /// Takes memory from the firmware's heap, about 99,000 bytes; 8-byte aligned, NULL when there
            /// is none.
            stdlib::malloc = malloc(size: SizeT) -> *mut Void, at 0x8001_DE70, cost 279, firmware;
            /// Takes cleared memory for `num` items of `size` bytes.
            stdlib::calloc = calloc(num: SizeT, size: SizeT) -> *mut Void, at 0x8001_E998, cost 300, firmware;
            /// Changes the size of a block; it may move.
            stdlib::realloc = realloc(packet: *mut Void, size: SizeT) -> *mut Void,
                at 0x8001_E360, cost 1000, firmware;
            /// Takes memory at a multiple of `alignment`.
            stdlib::memalign = memalign(alignment: SizeT, size: SizeT) -> *mut Void,
                at 0x8001_E710, cost 457, firmware;
            /// Gives a block back.
            stdlib::free = free(packet: *mut Void), at 0x8001_DFFC, cost 459, firmware;
            /// Next pseudo-random number.
            stdlib::rand = rand() -> i32, at 0x8002_6EF4, cost 157, firmware;
            /// Starts the pseudo-random sequence of `seed`.
            stdlib::srand = srand(seed: u32), at 0x8002_6E80, cost 142, firmware;
            /// Text to int.
            stdlib::atoi = atoi(st: *const Char) -> i32, at 0x8002_7660, cost 53, firmware;
            /// Text to long in the given base; the end goes to `*endptr`.
            stdlib::strtol = strtol(st: *const Char, endptr: *mut *mut Char, base: i32) -> Long,
                at 0x8002_29E0, cost 300, firmware;
            /// Text to unsigned long in the given base; the end goes to `*endptr`.
            stdlib::strtoul = strtoul(st: *const Char, endptr: *mut *mut Char, base: i32) -> UnsignedLong,
                at 0x8002_2E80, cost 273, firmware;
            /// Text to double; the end goes to `*endptr`.
            stdlib::strtod = strtod(st: *const Char, endptr: *mut *mut Char) -> f64,
                at 0x8002_2500, cost 164, firmware;
            /// Text to double; the end goes to `*endptr`.
            stdlib::strtold = strtold(st: *const Char, endptr: *mut *mut Char) -> f64,
                at 0x8002_2020, cost 164, firmware;
            /// Integer to decimal text; returns the length.
            stdlib::ltoa = ltoa(val: Long, buffer: *mut Char) -> i32, at 0x8002_7200, cost 10663, firmware;
            /// Double to `ndigit` significant digits in a static buffer.
            stdlib::ecvt = ecvt(value: f64, ndigit: i32, decpt: *mut i32, sign: *mut i32) -> *mut Char,
                at 0x8002_4AA0, cost 420, firmware;
            /// Double to digits with `ndigit` after the point in a static buffer.
            stdlib::fcvt = fcvt(value: f64, ndigit: i32, decpt: *mut i32, sign: *mut i32) -> *mut Char,
                at 0x8002_4DC0, cost 460, firmware;
            /// Registers a function for exit.
            stdlib::atexit = atexit(fun: fn() -> Void) -> i32, at 0x8002_5EDC, cost 162, firmware;
            /// Ends the program; in a thread as ThreadDone does.
            stdlib::exit = exit(status: i32), at 0x8002_5DCC, cost 200, firmware;
            /// Ends the program; in a thread as ThreadDone does.
            stdlib::abort = abort(), at 0x8002_5DC0, cost 200, firmware;
            /// Absolute value.
            stdlib::abs = abs(x: i32) -> i32, at 0x7000_01B0, cost 200, library;
            /// Absolute value.
            stdlib::labs = labs(x: Long) -> Long, at 0x7000_01B8, cost 200, library;
            /// Text to double.
            stdlib::atof = atof(s: *const Char) -> f64, at 0x7000_01C0, cost 200, library;
            /// Text to long.
            stdlib::atol = atol(s: *const Char) -> Long, at 0x7000_01C8, cost 200, library;
            /// Sorts `count` items of `size` bytes.
            stdlib::qsort = qsort(
                base: *mut Void, count: SizeT, size: SizeT, compare: fn(*const Void, *const Void) -> i32
            ), at 0x7000_01D0, cost 200, library;
            /// Finds `key` among sorted items, or NULL.
            stdlib::bsearch = bsearch(
                key: *const Void, base: *const Void, count: SizeT, size: SizeT,
                compare: fn(*const Void, *const Void) -> i32
            ) -> *mut Void, at 0x7000_01D8, cost 200, library;
        }
    };
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::tests::{Row, table};

    #[test]
    fn names_and_addresses_are_unique() {
        let names: BTreeSet<_> = FIRMWARE_FUNCTIONS.iter().map(|function| function.name).collect();
        let addresses: BTreeSet<_> = FIRMWARE_FUNCTIONS.iter().map(|function| function.address).collect();
        assert_eq!(names.len(), FIRMWARE_FUNCTIONS.len());
        assert_eq!(addresses.len(), FIRMWARE_FUNCTIONS.len());
    }

    #[test]
    fn attributes_agree_with_the_arguments() {
        for row in FIRMWARE_FUNCTIONS {
            let first = row.params.first().map(|param| param.role);
            assert!(!row.attributes.drives_axis || first == Some(Role::Axis), "{}", row.name);
            assert!(row.attributes.bit_access.is_none() || first == Some(Role::Bit), "{}", row.name);
            assert!(
                row.attributes.polls != Some(PolledState::Bit) || first == Some(Role::Bit),
                "{}",
                row.name
            );
            assert!(
                row.attributes.polls != Some(PolledState::Motion) || first == Some(Role::Axis),
                "{}",
                row.name
            );
            assert!(
                !row.attributes.is_pure || (row.attributes.waits.is_none() && row.result != CType::Void),
                "{}",
                row.name
            );
        }
    }

    #[test]
    fn registers_of_a_row_are_those_of_the_calling_convention_unless_it_names_others() {
        assert_eq!(Function::printf.row().attributes.changed_registers, 0x0000_03FF_0000_03FF);
        assert_eq!(Function::_divf.row().attributes.changed_registers, 0x0000_0061_0000_0018);
    }

    #[test]
    fn functions_are_found_by_name_and_by_address() {
        for (n, function) in FIRMWARE_FUNCTIONS.iter().enumerate() {
            assert_eq!(function_named(function.name), Some(n));
            assert_eq!(function_at(function.address), Some(n));
        }
        assert_eq!(function_named("Readbit"), None);
        assert_eq!(function_at(GuestAddr::NULL), None);
    }

    #[test]
    fn library_functions_have_ascending_addresses() {
        let library = FIRMWARE_FUNCTIONS.iter().filter(|function| function.origin == Origin::Library);
        for (function, offset) in library.zip((0..).step_by(8)) {
            assert_eq!(function.address, LIBRARY_BASE.offset(offset), "{}", function.name);
        }
    }

    #[test]
    fn rows_agree_with_the_specification() {
        let specified = table("functions.csv");
        let linkable: Vec<&Row> = specified.iter().filter(|row| !row["address"].is_empty()).collect();
        for row in &linkable {
            let function = FIRMWARE_FUNCTIONS[function_named(&row["name"]).expect(&row["name"])];
            assert_eq!(function.prototype(), row["signature"]);
            assert_eq!(format!("0x{:08X}", function.address.get()), row["address"], "{}", row["name"]);
            let declared = function.origin == Origin::Header;
            assert_eq!(declared, row["header_declares"] == "yes", "{}", row["name"]);
            assert_ne!(function.origin, Origin::Library, "{}", row["name"]);
        }
        let library = FIRMWARE_FUNCTIONS.iter().filter(|function| function.origin == Origin::Library);
        assert_eq!(linkable.len() + library.count(), FIRMWARE_FUNCTIONS.len());
    }
}
