//! The words sent to amplifiers, which programs can read in `LastPWM`. Source: io.md.

use kmotiondef::limits::{MAX_PWM_VALUE, MAX_PWMC_VALUE, MAX_PWMR_VALUE};
use kmotiondef::variables::LAST_PWM;
use vm::memory::GuestMemory;

use crate::views::TypedAccess;

/// Stores the word sent to a PWM channel.
#[inline]
pub(crate) fn store_pwm(memory: &mut GuestMemory, channel: i32, word: i32) {
    if let Some(channel) = usize::try_from(channel).ok().filter(|&channel| channel < 16) {
        memory.set(LAST_PWM.element(channel), word);
    }
}

/// The word for a locked-antiphase value.
#[inline]
pub(crate) fn antiphase(value: i32) -> i32 {
    value.clamp(-MAX_PWM_VALUE, MAX_PWM_VALUE) + 1280
}

/// The word for a recirculate value.
pub(crate) fn recirculate(value: i32) -> i32 {
    let value = value.clamp(-MAX_PWMR_VALUE, MAX_PWMR_VALUE);
    if value < 0 { 512 - value } else { value }
}

/// The word for a current-loop value.
#[inline]
pub(crate) fn current(value: i32) -> i32 {
    value.clamp(-MAX_PWMC_VALUE, MAX_PWMC_VALUE) + 41_984
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pwm_words_match_the_recording() {
        // `checks.jsonl`, row "LastPWM after the PWM commands".
        assert_eq!((antiphase(100), antiphase(-100)), (1380, 1180));
        assert_eq!((recirculate(100), recirculate(-100)), (100, 612));
        assert_eq!((current(500), current(-500)), (42_484, 41_484));
    }
}
