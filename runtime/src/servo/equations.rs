//! The servo against the manual's own formulas: difference equations of PID and filters, the table of lead values.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::variables::LAST_PWM;
use kmotiondef::{AxisId, Field};

use crate::testing::TestBench;
use crate::views::TypedAccess;

fn axis() -> AxisId {
    AxisId::new(0).expect("0 is an axis")
}

/// The coefficients of the recurrence, A with a plus sign.
#[derive(Clone, Copy)]
struct Coefficients {
    a1: f64,
    a2: f64,
    b0: f64,
    b1: f64,
    b2: f64,
}

/// A test bench with an axis 0 whose position is set by the test.
fn bench() -> TestBench {
    let mut bench = TestBench::new();
    bench.memory.set_axis(axis(), Chan::INPUT_MODE, InputMode::User.get());
    for (field, value) in [(Chan::P, 1.0), (Chan::MAX_OUTPUT, 1e6), (Chan::MAX_ERR, 1e6), (Chan::MAX_I, 1e6)]
    {
        bench.memory.set_axis(axis(), field, value);
    }
    bench.call("EnableAxisDest", &[0, 0]);
    bench
}

fn close(found: f32, expect: f64, scale: f64) -> bool {
    (f64::from(found) - expect).abs() <= 4e-6 * scale
}

#[test]
fn filters_follow_their_difference_equation() {
    let filters = [
        Coefficients { a1: 1.5, a2: -0.6, b0: 0.05, b1: 0.05, b2: 0.0 },
        Coefficients { a1: 0.0, a2: 0.0, b0: 0.25, b1: 0.5, b2: 0.25 },
        Coefficients { a1: 1.875, a2: -0.890_625, b0: 0.003_906_25, b1: 0.007_812_5, b2: 0.003_906_25 },
        Coefficients { a1: -0.5, a2: 0.25, b0: 1.0, b1: -0.75, b2: 0.125 },
    ];
    for number in 0..3 {
        for filter in filters {
            let mut bench = bench();
            let iir = Chan::IIR.element(number);
            let Coefficients { a1, a2, b0, b1, b2 } = filter;
            for (field, value) in [(Iir::A1, a1), (Iir::A2, a2), (Iir::B0, b0), (Iir::B1, b1), (Iir::B2, b2)]
            {
                bench.memory.set_axis(axis(), iir.field(field), value as f32);
            }
            bench.memory.set_axis(axis(), Chan::DEST, 100.0);
            let [mut x, mut y] = [[0.0_f64; 3]; 2];
            for tick in 0..200 {
                bench.run(1);
                x = [100.0, x[0], x[1]];
                y = [b0 * x[0] + b1 * x[1] + b2 * x[2] + a1 * y[0] + a2 * y[1], y[0], y[1]];
                let output = bench.memory.axis(axis(), Chan::OUTPUT);
                assert!(close(output, y[0], 100.0), "filter {number}, tick {tick}: {output} {}", y[0]);
            }
        }
    }
}

#[test]
fn the_compensation_follows_its_difference_equation() {
    let (p, i, d, max_i) = (2.0, 0.125, 16.0, 150.0);
    let mut bench = bench();
    let gains: [(Field<f32>, f32); 4] =
        [(Chan::P, 2.0), (Chan::I, 0.125), (Chan::D, 16.0), (Chan::MAX_I, 150.0)];
    for (field, value) in gains {
        bench.memory.set_axis(axis(), field, value);
    }
    bench.memory.set_axis(axis(), Chan::DEST, 50.0);
    let (mut sum, mut last) = (0.0_f64, 0.0);
    for tick in 0..100 {
        let position = 50.0 * (1.0 - libm::pow(0.95, f64::from(tick)));
        bench.memory.set_axis(axis(), Chan::POSITION, position);
        bench.run(1);
        let error = 50.0 - position;
        sum = (sum + i * error).clamp(-max_i, max_i);
        let expect = p * error + sum - d * (position - last);
        last = position;
        let output = bench.memory.axis(axis(), Chan::OUTPUT);
        assert!(close(output, expect, 200.0), "tick {tick}: {output} {expect}");
    }
}

/// Frequency in Hz and lead, as the manual's table has them.
const LEADS: [(f64, f64); 30] = [
    (50.0, 35.37),
    (60.0, 29.47),
    (70.0, 25.26),
    (80.0, 22.11),
    (90.0, 19.65),
    (100.0, 17.69),
    (120.0, 14.74),
    (140.0, 12.63),
    (160.0, 11.06),
    (180.0, 9.83),
    (200.0, 8.85),
    (220.0, 8.04),
    (240.0, 7.37),
    (260.0, 6.81),
    (280.0, 6.32),
    (300.0, 5.90),
    (350.0, 5.06),
    (400.0, 4.43),
    (450.0, 3.94),
    (500.0, 3.55),
    (550.0, 3.23),
    (600.0, 2.96),
    (650.0, 2.74),
    (700.0, 2.54),
    (750.0, 2.38),
    (800.0, 2.23),
    (850.0, 2.10),
    (900.0, 1.99),
    (950.0, 1.88),
    (1000.0, 1.79),
];

#[test]
fn lead_makes_a_knee_where_the_table_says() {
    for (frequency, lead) in LEADS {
        // At the knee the change from sample to sample, times the lead, is as large as the wave itself.
        let knee = 1.0 / (2.0 * libm::sin(std::f64::consts::PI * TIMEBASE * frequency));
        assert!((knee - lead).abs() <= 0.006, "{frequency} Hz: {knee} instead of {lead}");
        let mut bench = TestBench::new();
        bench.memory.set_axis(axis(), Chan::OUTPUT_MODE, OutputMode::Microstep.get());
        bench.memory.set_axis(axis(), Chan::OUTPUT_CHAN1, 1);
        bench.memory.set_axis(axis(), Chan::STEPPER_AMPLITUDE, 20.0);
        bench.memory.set_axis(axis(), Chan::LEAD, lead as f32);
        bench.call("EnableAxisDest", &[0, 0]);
        let (mut last, mut compared) = (0.0_f64, 0);
        for tick in 0..400 {
            let cycles = f64::from(tick) * TIMEBASE * frequency;
            bench.memory.set_axis(axis(), Chan::DEST, cycles);
            bench.run(1);
            let wave = f64::from(20.0 * super::sine::sine(cycles, 0));
            let expect = (wave + (wave - last) * lead).clamp(-230.0, 230.0);
            last = wave;
            let word = f64::from(bench.memory.get(LAST_PWM.element(0)) - 1280);
            if tick > 0 {
                assert!((word - expect).abs() <= 0.51, "{frequency} Hz, tick {tick}: {word} {expect}");
                compared += 1;
            }
        }
        assert_eq!(compared, 399);
    }
}
