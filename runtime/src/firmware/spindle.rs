//! Spindle measurement and threading. Source: coordinated-motion.md section 7.

use kmotiondef::variables::COORD_SYSTEM0;
use vm::firmware::Caller;

use super::parts::Parts;
use crate::out::Message;
use crate::servo::spindle::{self, Setup};
use crate::views::TypedAccess;

pub(crate) fn configure_spindle(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    kind: i32,
    axis: i32,
    update_time: f32,
    tau: f32,
    counts: f32,
) {
    let Some(axis) = caller.memory.axes().get(axis) else {
        parts.out.diagnose(caller, Message::NoSuchSpindleAxis { axis });
        return;
    };
    if counts == 0.0 || !counts.is_finite() {
        parts.out.diagnose(caller, Message::NoSpindleCounts { counts });
    }
    if let Some(real) = parts.machine.mechanics.spindle_counts(axis).filter(|_| kind == 1) {
        check_counts(parts, caller, counts, real);
    }
    spindle::configure(caller.memory, &Setup { has_encoder: kind == 1, axis, update_time, tau, counts });
}

/// Compares the given counts of a revolution with the machine's.
fn check_counts(parts: &mut Parts, caller: &Caller<'_>, counts: f32, real: f64) {
    const TOLERANCE: f64 = 0.01;
    let is = |number: f64, wanted: f64| (number.abs() / wanted - 1.0).abs() < TOLERANCE;
    let configured = f64::from(counts);
    if configured == 0.0 || is(configured, real.abs()) {
        return;
    }
    let hint = if is(configured, real.abs() / 4.0) { " (four for each line)" } else { "" };
    parts.out.diagnose(caller, Message::SpindleCounts { counts, real, hint });
}

pub(crate) fn trig_threading(parts: &mut Parts, caller: &mut Caller<'_>, base_speed: f32) {
    if !spindle::is_measured(caller.memory) {
        parts.out.diagnose(caller, Message::NoSpindle {});
    }
    if base_speed == 0.0 || !base_speed.is_finite() {
        parts.out.diagnose(caller, Message::NoBaseSpeed { speed: base_speed });
        return;
    }
    spindle::thread(caller.memory, base_speed);
    if caller.memory.get(COORD_SYSTEM0).is_null() {
        parts.out.diagnose(caller, Message::NothingToThread {});
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::AxisId;
    use kmotiondef::structs::{Chan, Spindle};
    use kmotiondef::variables::SPINDLE;

    use super::*;
    use crate::testing::TestBench;

    #[test]
    fn the_speed_is_measured_over_the_update_time() {
        let mut bench = TestBench::new();
        let float = |value: f32| u64::from(value.to_bits());
        bench.call("ConfigureSpindle", &[1, 0, float(0.1), float(0.1), float(4096.0)]);
        let axis = AxisId::new(0).expect("0 is an axis");
        bench.memory.set_axis(axis, Chan::INPUT_MODE, 4);
        for tick in 0..3000 {
            bench.memory.set_axis(axis, Chan::POSITION, 0.9 * f64::from(tick));
            bench.run(1);
        }
        // `coord.jsonl`, "spindle speed measurement".
        let speed = bench.memory.get(SPINDLE.field(Spindle::TRUE_SPEED_RPS));
        assert!((speed - 2.441_406).abs() < 1e-6, "{speed}");
    }

    #[test]
    fn nonsense_spindle_settings_are_reported() {
        let mut bench = TestBench::new();
        let float = |value: f32| u64::from(value.to_bits());
        bench.call("ConfigureSpindle", &[1, 9, float(0.1), float(0.1), float(4096.0)]);
        bench.call("TrigThreading", &[float(0.0)]);
        bench.run(100);
        assert_eq!(bench.kernel.parts.out.take_events().len(), 3);
    }
}
