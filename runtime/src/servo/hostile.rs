//! Absurd numbers: none of them may hang the servo, make it panic or move forever.

use kmotiondef::structs::{Chan, Iir};
use kmotiondef::{AxisId, Field, GuestAddr};

use crate::testing::TestBench;
use crate::views::TypedAccess;

const NONSENSE: [f64; 7] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0, 1e300, f64::MIN_POSITIVE];

fn axis() -> AxisId {
    AxisId::new(0).expect("0 is an axis")
}

fn bench() -> TestBench {
    let mut bench = TestBench::new();
    bench.call("EnableAxisDest", &[0, 0]);
    bench
}

#[test]
fn motions_with_nonsense_limits_or_targets_end() {
    for field in [Chan::VEL, Chan::ACCEL, Chan::JERK] {
        for value in NONSENSE {
            let mut bench = bench();
            bench.memory.set_axis(axis(), field, value as f32);
            bench.call("Move", &[0, 10.0_f64.to_bits()]);
            bench.call_in_slices("Jog", &[0, 5.0_f64.to_bits()]);
            bench.run(200);
        }
    }
    for value in NONSENSE {
        let mut bench = bench();
        let bits = value.to_bits();
        bench.call("Move", &[0, bits]);
        bench.run(50);
        bench.call_in_slices("MoveRel", &[0, bits]);
        bench.call_in_slices("Jog", &[0, bits]);
        bench.call_in_slices("MoveExp", &[0, bits, 0.1_f64.to_bits()]);
        bench.call_in_slices("MoveExp", &[0, 10.0_f64.to_bits(), bits]);
        bench.run(200);
        bench.call("EnableAxisDest", &[0, bits]);
        bench.run(50);
    }
}

/// The diagnostics but the hint that the axis has no output.
fn without_hints(mut texts: Vec<String>) -> Vec<String> {
    texts.retain(|text| !text.contains("has no OutputMode"));
    texts
}

#[test]
fn a_move_to_infinity_goes_on_and_is_reported() {
    let mut bench = bench();
    bench.call_in_slices("MoveRel", &[0, f64::INFINITY.to_bits()]);
    let told = without_hints(bench.diagnostics());
    assert!(matches!(&told[..], [text] if text.contains("the axis moves on without an end")), "{told:?}");
    bench.run(5000);
    assert!(bench.memory.axis(axis(), Chan::DEST) > 0.0);
    assert_eq!(bench.call_i32("CheckDone", &[0]), 0);
}

#[test]
fn invalid_targets_and_limits_move_nothing_and_are_reported() {
    let nan = f64::NAN.to_bits();
    let calls: [(&str, Vec<u64>); 5] = [
        ("Move", vec![0, nan]),
        ("MoveRel", vec![0, nan]),
        ("Jog", vec![0, nan]),
        ("MoveExp", vec![0, nan, 0.1_f64.to_bits()]),
        ("MoveXYZABC", vec![nan, 0, 0, 0, 0, 0]),
    ];
    for (name, arguments) in calls {
        let mut bench = bench();
        bench.memory.set(kmotiondef::variables::CS0_AXIS_Y, -1);
        bench.memory.set(kmotiondef::variables::CS0_AXIS_Z, -1);
        bench.memory.set(kmotiondef::variables::CS0_AXIS_A, -1);
        bench.call_in_slices(name, &arguments);
        let told = without_hints(bench.diagnostics());
        assert!(matches!(&told[..], [text] if text.contains("is not a valid position or speed")), "{told:?}");
        bench.run(10);
        assert_eq!(bench.memory.axis(axis(), Chan::DEST), 0.0, "{name}");
    }
    for field in [Chan::VEL, Chan::ACCEL, Chan::JERK] {
        for limit in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let mut bench = bench();
            bench.memory.set_axis(axis(), field, limit);
            bench.call("Move", &[0, 10.0_f64.to_bits()]);
            let told = without_hints(bench.diagnostics());
            assert_eq!(
                told,
                ["thread 1: Move: Vel, Accel and Jerk of axis 0 are not all positive"],
                "{limit}"
            );
            bench.run(10);
            assert_eq!(bench.memory.axis(axis(), Chan::DEST), 0.0, "{limit}");
        }
    }
}

#[test]
fn nonsense_gains_and_filters_still_give_an_output() {
    let gains: [Field<f32>; 12] = [
        Chan::P,
        Chan::I,
        Chan::D,
        Chan::MAX_I,
        Chan::MAX_ERR,
        Chan::MAX_OUTPUT,
        Chan::DEAD_BAND_RANGE,
        Chan::DEAD_BAND_GAIN,
        Chan::FF_VEL,
        Chan::INPUT_GAIN0,
        Chan::OUTPUT_GAIN,
        Chan::IIR.element(0).field(Iir::A1),
    ];
    for mode in 0..=9 {
        for field in gains {
            for value in NONSENSE {
                let mut bench = bench();
                bench.memory.set_axis(axis(), Chan::OUTPUT_MODE, mode);
                bench.memory.set_axis(axis(), field, value as f32);
                bench.memory.set_axis(axis(), Chan::DEST, 100.0);
                bench.run(5);
            }
        }
    }
}

#[test]
fn invalid_pointers_end_a_motion() {
    for pointer in [4_u32, 0x1234_5677, 0x4200_0010, 0x9100_0000, 0xFFFF_FFF0] {
        let mut bench = bench();
        bench.memory.set_axis(axis(), Chan::PCOEFF, GuestAddr::new(pointer));
        bench.run(3);
        bench.memory.set_axis(axis(), Chan::C, GuestAddr::new(pointer));
        bench.call("StartMove", &[0]);
        bench.call_in_slices("Move", &[0, 10.0_f64.to_bits()]);
        bench.run(100);
        assert_eq!(bench.call_i32("CheckDone", &[0]), 1, "{pointer:#x}");
        let told = "axis 0: pcoeff does not point to a list of states; its motion has ended";
        let found = without_hints(bench.diagnostics());
        assert!(!found.is_empty() && found.iter().all(|text| text == told), "{pointer:#x}: {found:?}");
    }
}
