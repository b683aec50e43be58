//! Digital and analog inputs and outputs. Source: io.md.

use kmotiondef::bits::{BitKind, range_of};
use kmotiondef::limits::{MAX_PWM_VALUE, MAX_PWMC_VALUE, MAX_PWMR_VALUE};
use kmotiondef::variables::{
    ADC_BUFFER_IN, BIT_DIR_SHADOW, BIT_DIR_SHADOW_SNAP0, BIT_DIR_SHADOW_SNAP1, KSTEP_PRESENT, LAST_PWM,
    VIRTUAL_BITS, VIRTUAL_BITS_EX,
};
use kmotiondef::{Bit, Cycles, Place};
use vm::firmware::Caller;
use vm::memory::GuestMemory;

use crate::kernel::Kernel;
use crate::views::Typed;

/// The first virtual bit.
const VIRTUAL: u16 = 48;
/// The first extended virtual bit.
const VIRTUAL_EX: u16 = 1024;
/// The first pin of SnapAmp 0 and of SnapAmp 1.
const SNAP: [u16; 2] = [64, 96];

/// The word and mask that hold a bit kept in memory.
fn memory_bit(bit: Bit, kind: BitKind) -> Option<(Place<i32>, i32)> {
    match kind {
        BitKind::Virtual => Some((VIRTUAL_BITS, 1 << (bit.get() - VIRTUAL))),
        BitKind::VirtualEx => {
            let number = bit.get() - VIRTUAL_EX;
            Some((VIRTUAL_BITS_EX.element(usize::from(number / 32)), 1 << (number % 32)))
        }
        _ => None,
    }
}

/// The word and mask that hold the direction of a SnapAmp's pin.
fn snap_direction(bit: Bit) -> (Place<i32>, i32) {
    if bit.get() < SNAP[1] {
        (BIT_DIR_SHADOW_SNAP0, 1 << (bit.get() - SNAP[0]))
    } else {
        (BIT_DIR_SHADOW_SNAP1, 1 << (bit.get() - SNAP[1]))
    }
}

/// Sets or clears `mask` in a word.
fn change(memory: &mut GuestMemory, word: Place<i32>, mask: i32, set: bool) {
    let value = memory.get(word);
    memory.set(word, if set { value | mask } else { value & !mask });
}

/// Checks a bit number that a program names.
fn checked(kernel: &mut Kernel, caller: &Caller<'_>, function: &str, bit: i32) -> Option<Bit> {
    let checked = Bit::new(bit);
    if checked.is_none() {
        kernel.diagnose(caller, format!("{function}({bit}): there are bits 0 to {}", Bit::MAX));
    }
    checked
}

pub(crate) fn set_bit_direction(kernel: &mut Kernel, caller: &mut Caller<'_>, bit: i32, direction: i32) {
    let Some(bit) = checked(kernel, caller, "SetBitDirection", bit) else { return };
    let output = direction != 0;
    match range_of(bit).map(|range| range.kind) {
        Some(BitKind::Pin) => {
            if output {
                kernel.check_jp7(caller, bit);
            }
            kernel.pins.set_output(bit, output, caller.now());
            let word = BIT_DIR_SHADOW.element(bit.index() / 32);
            change(caller.memory, word, 1 << (bit.get() % 32), output);
        }
        Some(BitKind::SnapGpio) => {
            let (word, mask) = snap_direction(bit);
            change(caller.memory, word, mask, output);
        }
        _ => {}
    }
    kernel.settle(caller.now());
}

/// 1 for outputs. Outputs of option boards count as 0, as the board has it.
pub(crate) fn get_bit_direction(kernel: &mut Kernel, caller: &mut Caller<'_>, bit: i32) -> i32 {
    let Some(bit) = checked(kernel, caller, "GetBitDirection", bit) else { return 0 };
    i32::from(match range_of(bit).map(|range| range.kind) {
        Some(BitKind::Pin | BitKind::Led) => kernel.pins.is_output(bit),
        Some(BitKind::Virtual) => true,
        _ => false,
    })
}

pub(crate) fn set_bit(kernel: &mut Kernel, caller: &mut Caller<'_>, bit: i32) {
    write(kernel, caller, "SetBit", bit, true);
}

pub(crate) fn clear_bit(kernel: &mut Kernel, caller: &mut Caller<'_>, bit: i32) {
    write(kernel, caller, "ClearBit", bit, false);
}

pub(crate) fn set_state_bit(kernel: &mut Kernel, caller: &mut Caller<'_>, bit: i32, state: i32) {
    write(kernel, caller, "SetStateBit", bit, state != 0);
}

fn write(kernel: &mut Kernel, caller: &mut Caller<'_>, function: &str, bit: i32, level: bool) {
    if let Some(bit) = checked(kernel, caller, function, bit) {
        let now = caller.now();
        write_bit(kernel, caller.memory, bit, level, now);
    }
}

/// Writes a bit; inputs and numbers that nothing answers ignore it.
pub(crate) fn write_bit(kernel: &mut Kernel, memory: &mut GuestMemory, bit: Bit, level: bool, now: Cycles) {
    let Some(kind) = range_of(bit).map(|range| range.kind) else { return };
    match kind {
        BitKind::Pin | BitKind::Led => kernel.pins.set_latch(bit, level, now),
        BitKind::KanalogOptoOutput | BitKind::KanalogFet | BitKind::KanalogOutput => {
            kernel.check_kanalog(memory, bit, now);
            kernel.pins.write(bit, level, now);
        }
        BitKind::SnapGpio => kernel.pins.write(bit, level, now),
        _ => {
            if let Some((word, mask)) = memory_bit(bit, kind) {
                change(memory, word, mask, level);
                kernel.pins.changes.sweep(memory, now);
            }
        }
    }
    kernel.settle(now);
}

/// The state of a bit and whether it is an input from outside.
pub(crate) fn bit_state(kernel: &Kernel, memory: &GuestMemory, bit: Bit) -> (bool, bool) {
    let pins = &kernel.pins;
    let Some(kind) = range_of(bit).map(|range| range.kind) else { return (false, false) };
    match kind {
        BitKind::Pin | BitKind::Led => (pins.level(bit), !pins.is_output(bit)),
        BitKind::KanalogOptoOutput | BitKind::KanalogFet | BitKind::KanalogOutput => {
            (pins.written(bit), false)
        }
        BitKind::SnapGpio => {
            let (word, mask) = snap_direction(bit);
            if memory.get(word) & mask != 0 { (pins.written(bit), false) } else { (pins.input(bit), true) }
        }
        // Nobody switches the banks of KStep's inputs through before it is said to be there.
        BitKind::KstepInput if memory.get(KSTEP_PRESENT) == 0 => (false, false),
        _ => match memory_bit(bit, kind) {
            Some((word, mask)) => (memory.get(word) & mask != 0, false),
            None => (pins.input(bit), true),
        },
    }
}

pub(crate) fn read_bit(kernel: &mut Kernel, caller: &mut Caller<'_>, bit: i32) -> i32 {
    let Some(bit) = checked(kernel, caller, "ReadBit", bit) else { return 0 };
    let (level, is_input) = bit_state(kernel, caller.memory, bit);
    if is_input && !kernel.pins.is_driven(bit) {
        kernel.undriven(caller, bit);
    }
    if is_input && let Some(assist) = &mut kernel.assist {
        assist.polled(bit, caller.thread);
    }
    i32::from(level)
}

/// The raw conversion of an analog input.
pub(crate) fn read_adc(kernel: &mut Kernel, caller: &mut Caller<'_>, channel: i32) -> i32 {
    let Some(channel) = usize::try_from(channel).ok().filter(|&channel| channel < 8) else {
        kernel.diagnose(caller, format!("ReadADC({channel}): there are channels 0 to 7"));
        return 0;
    };
    caller.memory.get(ADC_BUFFER_IN.element(channel))
}

/// Stores the word sent to a PWM channel.
#[inline]
pub(crate) fn store_pwm(memory: &mut GuestMemory, channel: i32, word: i32) {
    if let Some(channel) = usize::try_from(channel).ok().filter(|&channel| channel < 16) {
        memory.set(LAST_PWM.element(channel), word);
    }
}

/// The word of a locked-antiphase value.
#[inline]
pub(crate) fn antiphase(value: i32) -> i32 {
    value.clamp(-MAX_PWM_VALUE, MAX_PWM_VALUE) + 1280
}

/// The word of a recirculate value.
pub(crate) fn recirculate(value: i32) -> i32 {
    let value = value.clamp(-MAX_PWMR_VALUE, MAX_PWMR_VALUE);
    if value < 0 { 512 - value } else { value }
}

/// The word of a current-loop value.
#[inline]
pub(crate) fn current(value: i32) -> i32 {
    value.clamp(-MAX_PWMC_VALUE, MAX_PWMC_VALUE) + 41_984
}

pub(crate) fn write_pwm(_: &mut Kernel, caller: &mut Caller<'_>, channel: i32, value: i32) {
    store_pwm(caller.memory, channel, antiphase(value));
}

pub(crate) fn write_pwmr(_: &mut Kernel, caller: &mut Caller<'_>, channel: i32, value: i32) {
    store_pwm(caller.memory, channel, recirculate(value));
}

pub(crate) fn write_pwmc(_: &mut Kernel, caller: &mut Caller<'_>, channel: i32, value: i32) {
    store_pwm(caller.memory, channel, current(value));
}

#[cfg(test)]
mod tests {
    use kmotiondef::variables::KANALOG_PRESENT;

    use super::*;
    use crate::out::EventKind;
    use crate::testing::Desk;

    fn read(desk: &mut Desk, bit: u64) -> i32 {
        desk.call_i32("ReadBit", &[bit])
    }

    #[test]
    fn bits_answer_as_recorded() {
        // The exchange of `checks.jsonl`, row "bits".
        let mut desk = Desk::new();
        desk.call("SetBitDirection", &[5, 1]);
        assert_eq!(desk.call_i32("GetBitDirection", &[5]), 1);
        desk.call("SetBit", &[5]);
        assert_eq!(read(&mut desk, 5), 1);
        for (bit, direction) in [(48, 1), (64, 0), (80, 0), (128, 0), (144, 0), (160, 0)] {
            assert_eq!(desk.call_i32("GetBitDirection", &[bit]), direction, "{bit}");
        }
        for (bit, state) in [(144, 1), (128, 0), (200, 0), (63, 1)] {
            desk.call("SetBit", &[bit]);
            assert_eq!(read(&mut desk, bit), state, "{bit}");
        }
        assert_eq!(desk.memory.get(VIRTUAL_BITS), 32768);
    }

    #[test]
    fn a_latch_waits_for_the_direction() {
        let mut desk = Desk::new();
        desk.call("SetBit", &[8]);
        assert_eq!(read(&mut desk, 8), 0);
        desk.call("SetBitDirection", &[8, 1]);
        assert_eq!(read(&mut desk, 8), 1);
        assert_eq!(desk.memory.get(BIT_DIR_SHADOW.element(0)), 1 << 8);
    }

    #[test]
    fn the_diodes_are_lit() {
        let mut desk = Desk::new();
        assert_eq!(read(&mut desk, 46), 1);
        desk.call("ClearBit", &[46]);
        assert_eq!(read(&mut desk, 46), 0);
    }

    #[test]
    fn pins_that_kanalog_occupies_are_told_once() {
        let mut desk = Desk::new();
        desk.call("SetBitDirection", &[3, 1]);
        desk.memory.set(KANALOG_PRESENT, 1);
        for (bit, output) in [(3, 1), (4, 0), (16, 1), (5, 1), (6, 1)] {
            desk.call("SetBitDirection", &[bit, output]);
        }
        let told = desk.kernel.take_events();
        let [event] = &told[..] else { panic!("{told:?}") };
        assert!(
            matches!(&event.kind, EventKind::Diagnostic(text) if text.contains("bit 5 becomes")),
            "{event:?}"
        );
    }

    #[test]
    fn pwm_words_are_those_recorded() {
        // `checks.jsonl`, row "LastPWM after the PWM commands".
        assert_eq!((antiphase(100), antiphase(-100)), (1380, 1180));
        assert_eq!((recirculate(100), recirculate(-100)), (100, 612));
        assert_eq!((current(500), current(-500)), (42_484, 41_484));
    }
}
