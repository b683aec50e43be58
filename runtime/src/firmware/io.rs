//! Digital and analog inputs and outputs. Source: io.md.

use std::ops::RangeInclusive;

use kmotiondef::Bit;
use kmotiondef::bits::{BitDirection, BitKind, range_of};
use kmotiondef::firmware::Function;
use kmotiondef::limits::{MAX_PWM_VALUE, MAX_PWMC_VALUE, MAX_PWMR_VALUE};
use kmotiondef::variables::KSTEP_PRESENT;
use vm::firmware::{Caller, Outcome, Wake};

use super::axis_check;
use super::calls::{Continuation, OutputStage};
use super::costs;
use super::parts::Parts;
use crate::io::amplifiers::{antiphase, current, recirculate, store_pwm};
use crate::io::kanalog::Group;
use crate::io::kogna::INPUTS;
use crate::io::remark_on;
use crate::io::{bits, kanalog};
use crate::machine::{Channel, LateRead, MissedPulse, ReadNotice};
use crate::out::Message;
use crate::servo::wired::driver;
use crate::views::TypedAccess;
use crate::world::stimulus::InputReader;
use chips::fpga::kanalog_pin;
use chips::kanalog::{ADC_CHANNELS, ZERO};

/// Checks a bit number that a program names.
fn checked(parts: &mut Parts, caller: &Caller<'_>, function: Function, bit: i32) -> Option<Bit> {
    let checked = Bit::new(bit);
    if checked.is_none() {
        parts.out.diagnose(caller, Message::NoSuchBit { function, bit });
    }
    checked
}

pub(crate) fn set_bit_direction(parts: &mut Parts, caller: &mut Caller<'_>, bit: i32, direction: i32) {
    costs::spend_bit(caller, if direction == 0 { costs::TO_INPUT } else { costs::TO_OUTPUT }, bit);
    let Some(bit) = checked(parts, caller, Function::SetBitDirection, bit) else { return };
    let (is_output, now) = (direction != 0, caller.now());
    if is_output && (parts.io.pins.is_declared(bit) || parts.machine.mechanics.contact(bit).is_some()) {
        parts.out.diagnose(caller, Message::OutputAgainstInput { bit });
    }
    if is_output && range_of(bit).is_some_and(|range| range.kind == BitKind::Pin) {
        check_jp7(parts, caller, bit);
    }
    bits::set_direction(&mut parts.io, caller.memory, bit, is_output, now);
    parts.lines(now).settle();
}

/// A program makes a pin of JP7 an output.
fn check_jp7(parts: &mut Parts, caller: &Caller<'_>, bit: Bit) {
    let Parts { io, out, .. } = parts;
    if kanalog::is_served(&io.fpga, caller.memory)
        && !io.pins.is_output(bit)
        && let Some(notice) = kanalog_pin(bit)
    {
        out.diagnose(caller, remark_on(notice));
    }
}

/// 1 for outputs. Outputs of option boards count as 0, as the board has it.
pub(crate) fn get_bit_direction(parts: &mut Parts, caller: &mut Caller<'_>, bit: i32) -> i32 {
    let Some(bit) = checked(parts, caller, Function::GetBitDirection, bit) else { return 0 };
    i32::from(bits::is_output(&parts.io, caller.memory, bit))
}

pub(crate) fn set_bit(parts: &mut Parts, caller: &mut Caller<'_>, bit: i32) -> Outcome<()> {
    write(parts, caller, Function::SetBit, bit, true, costs::SET_BIT)
}

pub(crate) fn clear_bit(parts: &mut Parts, caller: &mut Caller<'_>, bit: i32) -> Outcome<()> {
    write(parts, caller, Function::ClearBit, bit, false, costs::CLEAR_BIT)
}

pub(crate) fn set_state_bit(parts: &mut Parts, caller: &mut Caller<'_>, bit: i32, state: i32) -> Outcome<()> {
    let costs = if state == 0 { costs::RESET_STATE_BIT } else { costs::SET_STATE_BIT };
    write(parts, caller, Function::SetStateBit, bit, state != 0, costs)
}

fn write(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    function: Function,
    bit: i32,
    level: bool,
    costs: costs::Ranges,
) -> Outcome<()> {
    if let (Some(_), Some(Continuation::Output(group, stage))) = (caller.woken, parts.calls.take(caller)) {
        go_on(parts, caller, group, stage);
        return Outcome::Done(());
    }
    costs::spend_bit(caller, costs, bit);
    let Some(bit) = checked(parts, caller, function, bit) else { return Outcome::Done(()) };
    check_written(parts, caller, function, bit);
    axis_check::switches(parts, caller, function, bit);
    if let Some(stage) = interrupted_at(parts, caller, function)
        && let Some(group) = parts.io.outputs.group_with(bit, level)
    {
        if stage == OutputStage::Stored {
            parts.io.outputs.store(group);
        }
        parts.calls.store(caller, Continuation::Output(group, stage));
        return Outcome::Wait(Wake::NextSlice);
    }
    switch(parts, caller, function, bit, level);
    Outcome::Done(())
}

/// A command writes a bit.
pub(crate) fn command_bit(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    function: Function,
    bit: i32,
    level: bool,
) {
    if let Some(bit) = checked(parts, caller, function, bit) {
        check_written(parts, caller, function, bit);
        switch(parts, caller, function, bit, level);
    }
}

/// Gives a bit its level.
fn switch(parts: &mut Parts, caller: &mut Caller<'_>, function: Function, bit: Bit, level: bool) {
    let now = caller.now();
    parts.lines(now).write(caller.memory, bit, level);
    if level
        && let Some(other) = parts.machine.opposite_output(bit)
        && bits::bit_state(&parts.io, caller.memory, other).0
    {
        parts.out.diagnose(caller, Message::BothDirections { function, bit, other });
    }
}

/// The place in a call that switches one of Kanalog's outputs where the slice ends, if what other threads do meanwhile is lost
/// there: the firmware loads the levels of the group and stores them, then loads them again and puts them out.
fn interrupted_at(parts: &Parts, caller: &Caller<'_>, function: Function) -> Option<OutputStage> {
    /// Cycles before the end of the call, the wait for the register among them.
    const STORED: RangeInclusive<i64> = 72..=77;
    const PUT_OUT: RangeInclusive<i64> = 64..=68;
    /// `SetStateBit` calls one of the others.
    const RETURN: i64 = 17;
    let after = if function == Function::SetStateBit { RETURN } else { 0 };
    let rest = -caller.budget.get() - after;
    let stage = if STORED.contains(&rest) {
        OutputStage::Read
    } else if PUT_OUT.contains(&rest) {
        OutputStage::Stored
    } else {
        return None;
    };
    (parts.calls.are_split && caller.thread.is_some()).then_some(stage)
}

/// A call that switches one of Kanalog's outputs goes on in the next slice.
fn go_on(parts: &mut Parts, caller: &Caller<'_>, group: Group, stage: OutputStage) {
    let now = caller.now();
    if stage == OutputStage::Read {
        parts.io.outputs.store(group);
    }
    group.put_out(&mut parts.io.pins, now);
    parts.lines(now).settle();
}

/// A program writes to a bit: whether that can have an effect.
fn check_written(parts: &mut Parts, caller: &Caller<'_>, function: Function, bit: Bit) {
    let Some(range) = bits::range_of(&parts.io, bit) else {
        return parts.out.diagnose(caller, Message::BitUnused { function, bit });
    };
    match range.direction {
        BitDirection::Input => parts.out.diagnose(caller, Message::InputWritten { function, bit }),
        BitDirection::Programmable if range.kind == BitKind::Pin && !parts.io.pins.is_output(bit) => {
            parts.calls.notices.latch(caller, function, bit);
        }
        BitDirection::Programmable | BitDirection::Output | BitDirection::Memory => {}
    }
}

/// A program reads a bit: whether it can ever change.
fn check_read(parts: &mut Parts, caller: &Caller<'_>, bit: Bit) {
    match bits::range_of(&parts.io, bit).map(|range| range.kind) {
        None => parts.out.diagnose(caller, Message::BitUnused { function: Function::ReadBit, bit }),
        Some(BitKind::KstepInput) if caller.memory.get(KSTEP_PRESENT) == 0 => {
            parts.out.diagnose(caller, Message::KstepAbsent { bit });
        }
        Some(BitKind::Pin) if parts.io.pins.is_generated(bit) && parts.io.stepgens.drives_pin(bit) => {
            parts.out.diagnose(caller, Message::StepPinRead { bit });
        }
        _ => {}
    }
}

pub(crate) fn read_bit(parts: &mut Parts, caller: &mut Caller<'_>, bit: i32) -> i32 {
    costs::spend_bit(caller, costs::READ_BIT, bit);
    let Some(bit) = checked(parts, caller, Function::ReadBit, bit) else { return 0 };
    let (level, is_input) = bits::bit_state(&parts.io, caller.memory, bit);
    let level = parts.io.outputs.level(bit).unwrap_or(level);
    if !is_input || bits::range_of(&parts.io, bit).is_none() {
        check_read(parts, caller, bit);
        return i32::from(level);
    }
    if let Some((axis, width, step)) = parts.machine.index_missed(bit, caller.now()) {
        parts.out.diagnose(caller, Message::IndexMissed { bit, axis, width, step });
    }
    let since = caller.thread.map(|thread| parts.calls.waits.wait_of(thread).since);
    if let Some(late) = parts.machine.read_late(bit, level, caller.now(), since) {
        let LateRead { axis, ms, step } = late;
        parts.out.diagnose(caller, Message::ReadLate { bit, axis, ms, step });
    }
    if let Some(notice) = parts.machine.pulses.read(bit, caller.at, level, caller.now()) {
        let message = match notice {
            ReadNotice::Missed(MissedPulse { width_ms, gap_ms }) => {
                Message::PulseMissed { bit, width_ms, gap_ms }
            }
            ReadNotice::Late { ms } => Message::SeenLate { bit, ms },
        };
        parts.out.diagnose(caller, message);
    }
    if let Some(assist) = &mut parts.world.assist {
        assist.polled(bit, InputReader { thread: caller.thread, at: caller.at });
    } else if !parts.io.pins.is_driven(bit) && !parts.io.pins.is_described(bit) {
        parts.out.diagnose(caller, Message::UndrivenInput { bit, level: level.into() });
    }
    i32::from(level)
}

/// Returns the reading of an analog input, -2048 to 2047, as the macro `ADC` does. The board reads 0 in place of the
/// conversion of a channel that does not exist.
pub(crate) fn read_adc(parts: &mut Parts, caller: &mut Caller<'_>, channel: i32) -> i32 {
    let level = analog_input(parts, caller, channel);
    let is_undriven = |index| index < ADC_CHANNELS && !parts.io.kanalog.is_connected(index);
    if usize::try_from(channel).is_ok_and(is_undriven) {
        parts.out.diagnose(caller, Message::UndrivenAdc { channel, level });
    }
    level
}

/// The value of an analog input: of a Kanalog, or on a Kogna of the board, which come after them.
pub(crate) fn analog_input(parts: &mut Parts, caller: &Caller<'_>, channel: i32) -> i32 {
    if let Some(kogna) = &parts.io.kogna
        && let Some(index) = usize::try_from(channel).ok().and_then(|index| index.checked_sub(ADC_CHANNELS))
        && index < INPUTS
    {
        return kogna.analog_input(caller.memory, index);
    }
    adc_level(parts, caller, channel) - ZERO
}

/// Returns the raw conversion of an analog input, without a remark about inputs that nothing drives.
pub(crate) fn adc_level(parts: &mut Parts, caller: &Caller<'_>, channel: i32) -> i32 {
    let Some(index) = usize::try_from(channel).ok().filter(|&index| index < ADC_CHANNELS) else {
        parts.out.diagnose(caller, Message::NoSuchAdc { channel });
        return 0;
    };
    kanalog::conversion(caller.memory, index)
}

/// A value for a PWM output: whether there is the channel, and it takes the value.
fn check_pwm(
    parts: &mut Parts,
    caller: &Caller<'_>,
    function: Function,
    (channel, value): (i32, i32),
    most: i32,
) {
    if !(0..16).contains(&channel) {
        parts.out.diagnose(caller, Message::NoSuchPwm { function, channel });
    } else if !(-most..=most).contains(&value) {
        parts.out.diagnose(caller, Message::PwmRange { function, channel, value, most });
    }
    if let Some(axis) = usize::try_from(channel).ok().and_then(|pwm| driver(caller.memory, Channel::Pwm(pwm)))
    {
        parts.out.diagnose(caller, Message::PwmOverwritten { function, channel, axis });
    }
}

pub(crate) fn write_pwm(parts: &mut Parts, caller: &mut Caller<'_>, channel: i32, value: i32) {
    check_pwm(parts, caller, Function::WritePWM, (channel, value), MAX_PWM_VALUE);
    store_pwm(caller.memory, channel, antiphase(value));
}

pub(crate) fn write_pwmr(parts: &mut Parts, caller: &mut Caller<'_>, channel: i32, value: i32) {
    check_pwm(parts, caller, Function::WritePWMR, (channel, value), MAX_PWMR_VALUE);
    store_pwm(caller.memory, channel, recirculate(value));
}

/// The first channel of a SnapAmp.
const FIRST_CURRENT: i32 = 8;

pub(crate) fn write_pwmc(parts: &mut Parts, caller: &mut Caller<'_>, channel: i32, value: i32) {
    check_pwm(parts, caller, Function::WritePWMC, (channel, value), MAX_PWMC_VALUE);
    // The board's own channels have no current mode.
    if channel >= FIRST_CURRENT {
        store_pwm(caller.memory, channel, current(value));
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_named};
    use kmotiondef::variables::{BIT_DIR_SHADOW, KANALOG_PRESENT, VIRTUAL_BITS};
    use kmotiondef::{Cycles, ThreadId};

    use super::*;
    use crate::out::EventKind;
    use crate::testing::TestBench;

    fn read(bench: &mut TestBench, bit: u64) -> i32 {
        bench.call_i32("ReadBit", &[bit])
    }

    #[test]
    fn bits_answer_as_recorded() {
        // The exchange of `checks.jsonl`, row "bits".
        let mut bench = TestBench::new();
        bench.call("SetBitDirection", &[5, 1]);
        assert_eq!(bench.call_i32("GetBitDirection", &[5]), 1);
        bench.call("SetBit", &[5]);
        assert_eq!(read(&mut bench, 5), 1);
        for (bit, direction) in [(48, 1), (64, 0), (80, 0), (128, 0), (144, 0), (160, 0)] {
            assert_eq!(bench.call_i32("GetBitDirection", &[bit]), direction, "{bit}");
        }
        for (bit, state) in [(144, 1), (128, 0), (200, 0), (63, 1)] {
            bench.call("SetBit", &[bit]);
            assert_eq!(read(&mut bench, bit), state, "{bit}");
        }
        assert_eq!(bench.memory.get(VIRTUAL_BITS), 32768);
    }

    /// Sets a relay in a slice that ends `rest` cycles before the call does; another thread sets the next one meanwhile. The
    /// levels of both as the firmware has them, and as they are.
    fn interrupted(rest: i64, call: &str, arguments: &[u64]) -> [bool; 4] {
        let mut bench = TestBench::new();
        bench.kernel.parts.calls.are_split = true;
        bench.memory.set(KANALOG_PRESENT, 1);
        let cost = function_named(call).map_or(0, |at| FIRMWARE_FUNCTIONS[at].cost.get()) + 42;
        let outcome = bench.outcome_within(Cycles::new(cost - rest), call, arguments, None);
        bench.kernel.parts.calls.are_split = false;
        bench.call_by(ThreadId::new(2), "SetBit", &[153]);
        if let Outcome::Wait(wake) = outcome {
            let done = bench.outcome(call, arguments, Some(wake));
            assert!(matches!(done, Outcome::Done(_)), "{call}: {done:?}");
        }
        let [first, second] = [152, 153].map(|bit| Bit::new(bit).expect("an output"));
        let io = &bench.kernel.parts.io;
        let known = [first, second].map(|bit| io.outputs.level(bit).expect("an output"));
        [known[0], known[1], io.pins.written(first), io.pins.written(second)]
    }

    #[test]
    fn outputs_of_kanalog_are_not_switched_in_one_piece() {
        for (rest, expect) in [
            (-1, [true; 4]),
            (63, [true; 4]),
            (66, [true, true, true, false]),
            (70, [true; 4]),
            (75, [true, false, true, false]),
            (80, [true; 4]),
        ] {
            assert_eq!(interrupted(rest, "SetBit", &[152]), expect, "{rest}");
        }
        assert_eq!(interrupted(75 + 17, "SetStateBit", &[152, 1]), [true, false, true, false]);
        assert_eq!(interrupted(75, "SetStateBit", &[152, 1]), [true; 4]);
    }

    #[test]
    fn a_latched_bit_takes_effect_when_its_pin_becomes_an_output() {
        let mut bench = TestBench::new();
        bench.call("SetBit", &[8]);
        assert_eq!(read(&mut bench, 8), 0);
        bench.call("SetBitDirection", &[8, 1]);
        assert_eq!(read(&mut bench, 8), 1);
        assert_eq!(bench.memory.get(BIT_DIR_SHADOW.element(0)), 1 << 8);
    }

    #[test]
    fn the_leds_are_on_at_power_up() {
        let mut bench = TestBench::new();
        assert_eq!(read(&mut bench, 46), 1);
        bench.call("ClearBit", &[46]);
        assert_eq!(read(&mut bench, 46), 0);
    }

    #[test]
    fn pins_used_by_kanalog_are_reported_once() {
        let mut bench = TestBench::new();
        bench.call("SetBitDirection", &[3, 1]);
        bench.memory.set(KANALOG_PRESENT, 1);
        for (bit, output) in [(3, 1), (4, 0), (16, 1), (5, 1), (6, 1)] {
            bench.call("SetBitDirection", &[bit, output]);
        }
        let told = bench.kernel.parts.out.take_events();
        let [event] = &told[..] else { panic!("{told:?}") };
        assert!(
            matches!(&event.kind, EventKind::Remark(remark) if remark.to_string().contains("bit 5 becomes")),
            "{event:?}"
        );
    }
}
