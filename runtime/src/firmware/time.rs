//! Time and waiting. Source: threads-and-time.md section 3.

use kmotiondef::Cycles;
use kmotiondef::firmware::Function;
use kmotiondef::limits::{CLOCKFREQ, TIMEBASE};
use kmotiondef::variables::{LAST_TIMER0, SERVO_TICK};
use vm::firmware::{Caller, Outcome, Wake};
use vm::memory::GuestMemory;

use super::float_bits;
use super::parts::Parts;
use crate::io::timer;
use crate::out::Message;
use crate::views::TypedAccess;

/// Cycles of one second, as a double.
const CYCLES_PER_SECOND: f64 = Cycles::PER_SECOND.get() as f64;

/// The cycles that a delay spends while it passes (costs.md section 3).
const WITHIN: Cycles = Cycles::new(124);

/// Seconds that are probably milliseconds, as for the warning `milliseconds`, unless they are whole minutes.
const LONG: f64 = 100.0;

/// Seconds since power-up, to 20 ns.
pub(crate) fn time_sec(_: &mut Parts, caller: &mut Caller<'_>) -> f64 {
    seconds(caller.memory, caller.now())
}

/// The time that `Time_sec` computes from the variables that programs see, in seconds.
pub(crate) fn seconds(memory: &GuestMemory, now: Cycles) -> f64 {
    let (count, rate) = if memory.has_other_map() {
        let map = memory.map();
        (timer::count_of(map, now) as u32, f64::from(map.counter) * 1e6)
    } else {
        (timer::count(now), CLOCKFREQ)
    };
    let since = count.wrapping_sub(memory.get(LAST_TIMER0));
    memory.get(SERVO_TICK) * TIMEBASE + f64::from(since) / rate
}

/// Waits until a time.
pub(crate) fn wait_until(parts: &mut Parts, caller: &mut Caller<'_>, time: f64) -> Outcome<()> {
    let remaining = time - seconds(caller.memory, caller.now());
    delay(parts, caller, remaining)
}

/// Waits this many seconds. The call-back cannot wait: it spends the time.
pub(crate) fn delay_sec(parts: &mut Parts, caller: &mut Caller<'_>, seconds: f64) -> Outcome<()> {
    if seconds >= LONG && seconds.is_finite() && seconds % 60.0 != 0.0 && caller.woken.is_none() {
        parts.out.diagnose(caller, Message::LongDelay { function: Function::Delay_sec, seconds });
    }
    _ = float_bits::check(parts, caller, Function::Delay_sec, seconds);
    delay(parts, caller, seconds)
}

fn delay(parts: &Parts, caller: &mut Caller<'_>, seconds: f64) -> Outcome<()> {
    if caller.woken.is_some() || seconds.is_nan() || seconds <= 0.0 {
        return Outcome::Done(());
    }
    let cycles = Cycles::new(libm::ceil(seconds * CYCLES_PER_SECOND) as i64);
    if caller.thread.is_none() && cycles < Cycles::PER_TICK {
        caller.spend(cycles);
        return Outcome::Done(());
    }
    // A delay of 1 µs takes 384 cycles on the board: most of the call's own time is a part of it.
    let within = if parts.timing.wait_states().is_some() { WITHIN.min(cycles) } else { Cycles::default() };
    Outcome::Wait(Wake::At(caller.now() + cycles - within))
}

/// Waits for the caller's next slice and returns its time.
pub(crate) fn wait_next_time_slice(_: &mut Parts, caller: &mut Caller<'_>) -> Outcome<f64> {
    match caller.woken {
        Some(_) => Outcome::Done(seconds(caller.memory, caller.now())),
        None => Outcome::Wait(Wake::NextSlice),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TestBench;

    #[test]
    fn time_counts_from_the_tick() {
        let mut bench = TestBench::new();
        bench.memory.set(SERVO_TICK, 1000.0);
        bench.set_now(Cycles::new(1000 * 18_000 + 9_000));
        bench.memory.set(LAST_TIMER0, 1000 * 4_500);
        let now = bench.call_f64("Time_sec", &[]);
        // The call itself costs 400 ns.
        assert!((now - (0.09 + 45e-6 + 4e-7)).abs() < 1e-12, "{now}");
    }

    #[test]
    fn zero_and_past_times_return_at_once() {
        let mut bench = TestBench::new();
        for seconds in [0.0, -1.0, f64::NAN] {
            assert!(bench.is_done("Delay_sec", &[seconds.to_bits()]));
            assert!(bench.is_done("WaitUntil", &[seconds.to_bits()]));
        }
        assert!(!bench.is_done("Delay_sec", &[1e-6_f64.to_bits()]));
        assert!(!bench.is_done("WaitNextTimeSlice", &[]));
    }
}
