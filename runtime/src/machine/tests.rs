//! Machines connected to the board, as seen by programs.

use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;

use kmotiondef::AxisId;
use kmotiondef::limits::TIMEBASE;

use crate::board::connect::{connect_surroundings, install};
use crate::board::machine_file::MachineFile;
use crate::testing::TestBench;
use crate::views::TypedAccess;

fn axis(number: i32) -> AxisId {
    AxisId::new(number).expect("an axis")
}

fn bench(machine: &str) -> TestBench {
    let machine = MachineFile::parse(machine).unwrap_or_else(|error| panic!("{}: {error}", error.line));
    let mut bench = TestBench::new();
    install(&mut bench.kernel.parts, &machine);
    connect_surroundings(&mut bench.kernel.parts, &machine, &mut bench.memory);
    bench
}

/// A bench with a motor on axis 0, enabled as a servo at position 0, for a command to 400 with the limits in the
/// reference table of plant.md.
fn servo(p: f32, i: f32, d: f32) -> TestBench {
    let mut bench = bench("[axis.0]\nmodel = \"motor\"");
    for (field, value) in [(Chan::P, p), (Chan::I, i), (Chan::D, d), (Chan::MAX_OUTPUT, 230.0)] {
        bench.memory.set_axis(axis(0), field, value);
    }
    bench.memory.set_axis(axis(0), Chan::OUTPUT_MODE, OutputMode::DcServo.get());
    bench.call("EnableAxisDest", &[0, 0]);
    bench.run(1);
    bench.memory.set_axis(axis(0), Chan::DEST, 400.0);
    bench
}

/// The time at which 90 % of the step are reached, the highest load, and the time from which it stays within 2 %, in
/// ms.
fn response(bench: &mut TestBench, ticks: u64) -> [f64; 3] {
    let (mut rise, mut peak, mut settled) = (None, 0.0_f64, 0);
    for tick in 1..=ticks {
        bench.run(1);
        let load = bench.kernel.parts.machine.loads[AxisId::new(0).expect("an axis")].load;
        peak = peak.max(load);
        if load >= 360.0 {
            rise.get_or_insert(tick);
        }
        if (load - 400.0).abs() > 8.0 {
            settled = tick;
        }
    }
    let milliseconds = |ticks: u64| ticks as f64 * TIMEBASE * 1e3;
    [rise.map_or(f64::NAN, milliseconds), peak, milliseconds(settled)]
}

#[test]
fn servos_with_a_motor_respond_as_the_table_says() {
    let table = [
        (0.5, 0.0, 50.0, [25.5, 417.0, 56.0]),
        (1.0, 0.0, 50.0, [15.9, 463.0, 55.0]),
        (2.0, 0.0, 100.0, [15.0, 434.0, 32.0]),
        (0.5, 0.002, 50.0, [18.4, 596.0, 141.0]),
        (10.0, 0.0, 0.0, [13.5, 597.0, 149.0]),
    ];
    for (p, i, d, expect) in table {
        let found = response(&mut servo(p, i, d), 4000);
        let is_near = (found[0] / expect[0] - 1.0).abs() < 0.02
            && (found[1] - expect[1]).abs() < 2.0
            && (found[2] / expect[2] - 1.0).abs() < 0.02;
        assert!(is_near, "P {p} I {i} D {d}: {found:?} instead of {expect:?}");
    }
}

/// Returns the range of the output half a second after a step.
fn swing(gain: f32) -> f32 {
    let mut bench = servo(gain, 0.0, 50.0 * gain);
    bench.run(5000);
    let outputs: Vec<f32> = (0..1000)
        .map(|_| {
            bench.run(1);
            bench.memory.axis(axis(0), Chan::OUTPUT)
        })
        .collect();
    outputs.iter().copied().fold(f32::MIN, f32::max) - outputs.iter().copied().fold(f32::MAX, f32::min)
}

#[test]
fn a_hundred_times_the_gain_is_unstable() {
    assert!(swing(1.0) < 60.0, "{}", swing(1.0));
    // From one end of the amplifier's range to the other.
    assert_eq!(swing(100.0), 460.0);
}

#[test]
fn switches_close_at_their_positions() {
    let mut bench = bench(
        "[[switch]]\nbit = 136\naxis = 0\nwhen = \"<= -100\"\n[[switch]]\nbit = 136\naxis = 0\nwhen = \">= 50\"\n\
         [[switch]]\nbit = 137\naxis = 0\nwhen = \"between 10 20\"\nactive = 0\n\
         [axis.0]\nindex = { bit = 138, every = 10, width = 2, offset = 1 }",
    );
    bench.memory.set_axis(axis(0), Chan::OUTPUT_MODE, OutputMode::StepDir.get());
    bench.call("EnableAxisDest", &[0, 0]);
    for (place, levels) in [
        (0.0, [0, 1, 0]),
        (15.0, [0, 0, 0]),
        (49.0, [0, 1, 0]),
        (50.0, [1, 1, 0]),
        (-100.0, [1, 1, 0]),
        (-99.0, [0, 1, 1]),
    ] {
        bench.memory.set_axis(axis(0), Chan::DEST, place);
        bench.run(20);
        let found = [136, 137, 138].map(|bit| bench.call_i32("ReadBit", &[bit]));
        assert_eq!(found, levels, "{place}");
    }
}

#[test]
fn a_machine_without_encoders_stays_at_zero() {
    let mut bench = bench("[axis.0]\nencoder = false");
    bench.memory.set_axis(axis(0), Chan::OUTPUT_MODE, OutputMode::StepDir.get());
    bench.call("EnableAxisDest", &[0, 0]);
    bench.memory.set_axis(axis(0), Chan::DEST, 100.0);
    bench.run(100);
    assert_eq!(bench.kernel.parts.machine.loads[AxisId::new(0).expect("an axis")].load, 100.0);
    assert_eq!(bench.memory.axis(axis(0), Chan::POSITION), 0.0);
}

#[test]
fn a_handwheel_turns_its_encoder() {
    let mut bench = bench("[[encoder]]\nchannel = 3\nmoves = [[0.01, 40, 0.1], [0.2, -15, 0.01]]");
    bench.run(2000);
    assert_eq!(bench.memory.axis(axis(3), Chan::POSITION), 40.0);
    bench.run(2000);
    assert_eq!(bench.memory.axis(axis(3), Chan::POSITION), 25.0);
}

#[test]
fn a_spindle_is_driven_by_its_axis() {
    let mut bench = bench(
        "[spindle]\naxis = 6\ncounts_per_rev = 1000\ndriven_by = \"axis 7\"\nfull_scale_rps = 20.47\ntau_s = 0.05",
    );
    bench.memory.set_axis(axis(7), Chan::OUTPUT_MODE, OutputMode::DacServo.get());
    bench.memory.set_axis(axis(7), Chan::INPUT_MODE, InputMode::None.get());
    for (field, value) in
        [(Chan::P, 0.0), (Chan::FF_VEL, 1.0), (Chan::MAX_OUTPUT, 2047.0), (Chan::OUTPUT_GAIN, 1.0)]
    {
        bench.memory.set_axis(axis(7), field, value);
    }
    bench.memory.set_axis(axis(7), Chan::OUTPUT_CHAN0, 7);
    bench.call("EnableAxisDest", &[7, 0]);
    bench.call("Jog", &[7, 1000.0_f64.to_bits()]);
    bench.run(10_000);
    let before = bench.memory.axis(axis(6), Chan::POSITION);
    bench.run(1111);
    // 1000 of 2047 counts are 10 revolutions per second; 1111 ticks are 0.1 s.
    let turned = bench.memory.axis(axis(6), Chan::POSITION) - before;
    assert!((turned - 1000.0).abs() <= 3.0, "{turned}");
}

#[test]
fn a_rotor_turns_with_its_vector() {
    let mut bench = bench("");
    bench.memory.set_axis(axis(0), Chan::OUTPUT_MODE, OutputMode::Brushless3Ph.get());
    bench.memory.set_axis(axis(0), Chan::INV_DIST_PER_CYCLE, 0.001);
    let chan0 = crate::views::chan(axis(0)).address().get();
    let mut apply = |angle: f64, ticks| {
        bench.call("Write3PH", &[chan0.into(), 100.0_f32.to_bits().into(), angle.to_bits()]);
        bench.run(ticks);
        bench.memory.axis(axis(0), Chan::POSITION)
    };
    let start = apply(0.0, 2000);
    for step in 1..=1000 {
        apply(f64::from(step) / 1000.0, 2);
    }
    let end = apply(1.0, 1111);
    assert!((end - start - 1000.0).abs() <= 2.0, "{start} {end}");
}

#[test]
fn a_brushless_axis_with_a_wrong_offset_is_reported_once() {
    for (offset, is_told) in [(0.0, false), (250.0, true), (500.0, true), (100.0, false)] {
        let mut bench = bench("");
        bench.memory.set_axis(axis(0), Chan::OUTPUT_MODE, OutputMode::Brushless3Ph.get());
        bench.memory.set_axis(axis(0), Chan::INV_DIST_PER_CYCLE, 0.001);
        bench.memory.set_axis(axis(0), Chan::COMMUTATION_OFFSET, offset);
        bench.call("EnableAxisDest", &[0, 0]);
        bench.call("Move", &[0, 1000.0_f64.to_bits()]);
        bench.run(5000);
        let told = bench.diagnostics();
        assert_eq!(told.len(), usize::from(is_told), "offset {offset}: {told:?}");
        assert!((bench.memory.axis(axis(0), Chan::POSITION) - 1000.0).abs() <= 1.0);
    }
}

#[test]
fn wires_connect_outputs_to_inputs() {
    let mut bench =
        bench("[[wire]]\nfrom = 8\nto = 12\n[[wire]]\nfrom = 8\nto = 13\ninvert = true\ndelay_s = 0.001");
    bench.call("SetBitDirection", &[8, 1]);
    bench.run(20);
    assert_eq!([12, 13].map(|bit| bench.call_i32("ReadBit", &[bit])), [0, 1]);
    bench.call("SetBit", &[8]);
    bench.run(2);
    assert_eq!([12, 13].map(|bit| bench.call_i32("ReadBit", &[bit])), [1, 1]);
    bench.run(20);
    assert_eq!([12, 13].map(|bit| bench.call_i32("ReadBit", &[bit])), [1, 0]);
}

#[test]
fn inputs_may_idle_high() {
    let mut bench = bench("[inputs]\nidle_high = [136, \"140-141\"]\nhints = false");
    assert_eq!([136, 137, 140, 141].map(|bit| bench.call_i32("ReadBit", &[bit])), [1, 0, 1, 1]);
    assert!(bench.kernel.parts.out.take_events().is_empty());
}
