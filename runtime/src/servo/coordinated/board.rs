//! The path on the board: its bits are connected to the board's lines.

use kmotiondef::Bit;
use kmotiondef::variables::{COORD_SYSTEM0, KLP, TAU_KLP};
use vm::memory::GuestMemory;

use super::Bits;
use super::segment::SIZE;
use super::system;
use crate::machine::Lines;
use crate::out::Message;
use crate::servo::state::Tick;
use crate::views::TypedAccess;

impl Bits for Lines<'_> {
    fn is_high(&mut self, memory: &GuestMemory, bit: Bit) -> bool {
        self.level(memory, bit)
    }

    fn drive(&mut self, memory: &mut GuestMemory, bit: Bit, high: bool) {
        self.write(memory, bit, high);
    }
}

/// Executes one tick of the path; returns whether it has moved or will move.
pub(crate) fn tick(tick: &mut Tick<'_>, memory: &mut GuestMemory) -> bool {
    let list = memory.get(COORD_SYSTEM0);
    if !list.is_null() && memory.block::<{ SIZE as usize }>(list).is_none() {
        tick.out.remark(tick.now, Message::NoSegments { list });
    }
    if !list.is_null() && system::is_disabled(memory) {
        tick.out.remark(tick.now, Message::PathDisabled {});
    }
    let mut lines = Lines { machine: tick.machine, io: tick.io, out: tick.out, now: tick.now };
    let goes_on = tick.servo.coordinated.tick(memory, &mut lines);
    let has_ended = !list.is_null() && memory.get(COORD_SYSTEM0).is_null();
    if has_ended && memory.get(KLP) > 0.0 && memory.get(TAU_KLP) == 0.0 {
        tick.out.remark(tick.now, Message::KlpWithoutTau {});
    }
    goes_on
}

#[cfg(test)]
mod tests {
    use kmotiondef::AxisId;
    use kmotiondef::modes::TrajectoryMode;
    use kmotiondef::structs::{Chan, ParametricCoeff, TripCircleLinear};
    use kmotiondef::variables::{
        CHAN, CS0_FLUSHED, CS0_STOPPING_STATE, LAST_COORD_SYSTEM0, PARAMETRIC_COEFFS, VIRTUAL_BITS_EX,
    };

    use super::super::segment::{Command, Entry};
    use super::*;
    use crate::testing::TestBench;

    /// A bench with axes 0 and 1 enabled, and a path as a program builds it: X to 100 at 1000 units per second, then a
    /// bit and 0.1 s more.
    fn bench() -> TestBench {
        let mut bench = TestBench::new();
        let unused = u32::MAX.into();
        bench.call("DefineCoordSystem", &[0, 1, unused, unused]);
        for axis in [0, 1] {
            bench.call("EnableAxisDest", &[axis, 0]);
        }
        let (start, bit) = (bench.memory.get(PARAMETRIC_COEFFS), Bit::new(1040).expect("a bit"));
        put_line(&mut bench.memory, Entry::at(start), 0.0);
        put_command(&mut bench.memory, Entry::at(start.offset(SIZE)), Command::Drive(bit, true));
        put_line(&mut bench.memory, Entry::at(start.offset(2 * SIZE)), 100.0);
        Entry::at(start.offset(3 * SIZE)).end_path(&mut bench.memory);
        bench.memory.set(CS0_FLUSHED, 1);
        bench.memory.set(LAST_COORD_SYSTEM0, start);
        bench.memory.set(COORD_SYSTEM0, start);
        bench
    }

    /// 100 units of X in 0.1 s.
    fn put_line(memory: &mut GuestMemory, entry: Entry, from: f64) {
        memory.write_bytes(entry.address(), &[255; 9]).expect("mapped");
        memory.set(entry.field(ParametricCoeff::TRAJECTORY_MODE), TrajectoryMode::Linear.get() as i8);
        memory.set(entry.field(ParametricCoeff::X_AXIS), 0);
        memory.set(entry.field(ParametricCoeff::T), 0.1);
        memory.set(entry.field(ParametricCoeff::C), 10.0);
        memory.set(entry.field(ParametricCoeff::COORD_X.field(TripCircleLinear::C)), 100.0);
        memory.set(entry.field(ParametricCoeff::COORD_X.field(TripCircleLinear::D)), from);
    }

    fn put_command(memory: &mut GuestMemory, entry: Entry, command: Command) {
        let (number, bit) = command.encode();
        memory.set(entry.field(ParametricCoeff::TRAJECTORY_MODE), TrajectoryMode::Special.get() as i8);
        memory.set(entry.field(ParametricCoeff::X_AXIS), number);
        memory.set(entry.field(ParametricCoeff::SPECIAL_PARAM), bit);
    }

    fn dest(bench: &TestBench) -> f64 {
        bench.memory.axis(AxisId::new(0).expect("0 is an axis"), Chan::DEST)
    }

    #[test]
    fn a_path_built_by_a_program_moves_axes_and_bits() {
        let mut bench = bench();
        bench.run(1000);
        assert!((dest(&bench) - 90.0).abs() < 0.01, "{}", dest(&bench));
        assert_eq!(bench.memory.get(VIRTUAL_BITS_EX.element(0)), 0);
        assert_eq!(bench.call_i32("CheckDoneBuf", &[]), 0);
        bench.run(200);
        assert!((dest(&bench) - 108.0).abs() < 0.01, "{}", dest(&bench));
        assert_eq!(bench.memory.get(VIRTUAL_BITS_EX.element(0)), 1 << 16);
        bench.run(2000);
        assert_eq!(bench.call_i32("CheckDoneBuf", &[]), 1);
        assert!((dest(&bench) - 200.0).abs() < 0.1, "{}", dest(&bench));
    }

    #[test]
    fn a_feedhold_stops_on_the_path_and_resumes() {
        let mut bench = bench();
        bench.run(100);
        bench.call_in_slices("StopCoordinatedMotion", &[]);
        assert_eq!(bench.memory.get(CS0_STOPPING_STATE), 1);
        bench.run(5000);
        assert_eq!(bench.memory.get(CS0_STOPPING_STATE), 3);
        let held = dest(&bench);
        bench.run(100);
        assert_eq!(dest(&bench), held);
        assert_eq!(bench.call_i32("CheckDoneBuf", &[]), 0);
        bench.call_in_slices("ResumeCoordinatedMotion", &[]);
        bench.run(20_000);
        assert_eq!(bench.call_i32("CheckDoneBuf", &[]), 1);
        assert!((dest(&bench) - 200.0).abs() < 0.1);
    }

    #[test]
    fn an_invalid_pointer_ends_the_path_and_is_reported() {
        let mut bench = bench();
        bench.memory.set(COORD_SYSTEM0, kmotiondef::GuestAddr::new(0x1234_5678));
        bench.run(2);
        assert!(bench.memory.get(COORD_SYSTEM0).is_null());
        assert_eq!(
            bench.diagnostics(),
            ["CoordSystem0 is 0x12345678, where there are no segments; the path has ended"]
        );
    }

    #[test]
    fn disabling_or_zeroing_an_axis_ends_the_path() {
        for function in ["DisableAxis", "Zero"] {
            let mut bench = bench();
            bench.run(100);
            bench.call(function, &[1]);
            assert!(bench.memory.get(COORD_SYSTEM0).is_null());
            assert!(bench.memory.get(LAST_COORD_SYSTEM0).is_null());
        }
    }

    #[test]
    fn a_path_runs_to_its_end_whatever_is_written_to_enable() {
        let mut bench = bench();
        bench.run(100);
        bench.memory.set(CHAN.element(0).field(Chan::ENABLE), 0);
        assert_eq!(bench.call_i32("CheckDoneBuf", &[]), -1);
        bench.run(20_000);
        assert!(bench.memory.get(COORD_SYSTEM0).is_null());
        assert!((dest(&bench) - 200.0).abs() < 0.1, "{}", dest(&bench));
    }
}
