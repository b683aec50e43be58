//! Register writes of each output mode, tick by tick: rows of kind `output`.

use serde_json::Value as Json;

use super::servo::enabled;
use super::{Released, list, number};

/// Writes of a recorded list.
fn writes(list: &Json) -> Vec<(usize, u16)> {
    let pair = |pair: &Json| (number(&pair[0]) as usize, number(&pair[1]) as u16);
    super::list(list).iter().map(pair).collect()
}

/// The number of cycles by which an interrupt may read a generator earlier or later than in the recording: it begins
/// when the interrupted code allows it, and the position in that code was not recorded.
const LATE: f64 = 64.0;
/// The value of the last bit with which a generator is read, in steps.
const READ: f64 = 1.0 / 128.0;
/// The number of steps per tick for a rate of one unit.
const RATE: f64 = 18_000.0 / 12.0 / (1 << 23) as f64;
/// The registers of a rate; the write to the last one makes it effective.
const RATES: std::ops::RangeInclusive<usize> = 0x3C..=0x3F;

/// The row with bytes of three phases on channels below 8, which the firmware writes to unused addresses between
/// registers. Of the four recorded ones, the second is in a register.
const BESIDE: &str = "BRUSHLESS mode 3, invDistPerCycle 0.001, CommutationOffset 0.1";

/// The writes to registers in a recorded list.
fn of_registers(row: &Json, writes: Vec<(usize, u16)>) -> Vec<(usize, u16)> {
    if row["name"] != BESIDE {
        return writes;
    }
    writes.into_iter().skip(1).step_by(4).collect()
}

/// The rate that writes make effective, in units; `None` for other writes.
fn rate(writes: &[(usize, u16)]) -> Option<f64> {
    let byte =
        |register: usize| writes.iter().find(|write| write.0 == register).map(|write| i32::from(write.1));
    let is_rate = writes.len() == 4 && writes.iter().all(|write| RATES.contains(&write.0));
    let [low, middle, high] = [0x3C, 0x3D, 0x3E].map(byte);
    let bits = is_rate.then_some(low? | middle? << 8 | high? << 16)?;
    Some(f64::from(bits << 9 >> 9))
}

/// The first writes after a command, as many as were recorded, or the last ones.
fn written_by(board: &mut Released, command: &str, row: &Json, found: &mut Vec<String>) {
    let is_first = command.starts_with("Enable");
    let expect =
        if is_first { of_registers(row, writes(&row["at_enable"])) } else { writes(&row["at_disable"]) };
    drop(board.writes());
    board.command(command);
    let mut written = board.writes();
    if is_first {
        written.truncate(expect.len());
    } else {
        written.drain(..written.len().saturating_sub(expect.len()));
    }
    if written != expect {
        found.push(format!("{command} writes {written:?}, recorded {expect:?}"));
    }
}

fn check_words(board: &Released, place: &str, values: &Json, found: &mut Vec<String>) {
    let words = board.address("LastPWM");
    for (channel, word) in values["LastPWM"].as_object().expect("words") {
        let at = words.offset(4 * channel.parse::<u32>().expect("a channel"));
        let is: i32 = board.board.memory().peek(at);
        if f64::from(is) != number(word) {
            found.push(format!("{place} PWM {channel}: {is}, recorded {word}"));
        }
    }
    if !values["DAC"].is_null() {
        let word = number(&values["DAC"]);
        let at = board.address("DAC_Buffer").offset(2 * board.peek("OutputChan0") as u32);
        let is: i16 = board.board.memory().peek(at);
        if f64::from(is) != word {
            found.push(format!("{place} DAC: {is}, recorded {word}"));
        }
    }
}

/// Checks a generator and its new rate, as far as the recording determines them; `before` is the number of steps in the
/// last tick.
fn check_generator(
    board: &mut Released,
    place: &str,
    values: &Json,
    before: f64,
    found: &mut Vec<String>,
) -> f64 {
    let (written, expect) = (board.writes(), writes(&values["writes"]));
    let generator = board.peek("OutputChan0") as usize & 7;
    let (steps, per_second) = board.board.steps(generator);
    let tick = per_second / 2e8 * 18_000.0;
    let allowed = before.abs().max(tick.abs()) * LATE / 18_000.0 + 2.0 * READ;
    let recorded = number(&values["generator_position"]);
    if (steps - recorded).abs() > allowed {
        found.push(format!("{place}: {steps} steps, recorded {recorded}"));
    }
    let is_near = |found: f64, expect: f64| (found - expect).abs() * RATE <= allowed;
    let order = |writes: &[(usize, u16)]| writes.iter().map(|write| write.0).collect::<Vec<_>>();
    let agree = match (rate(&written), rate(&expect)) {
        (Some(found), Some(expect)) => {
            is_near(found, expect) && written.last() == writes(&values["writes"]).last()
        }
        _ => written == expect,
    };
    if !agree || order(&written) != order(&expect) {
        found.push(format!("{place}: writes {written:?}, recorded {expect:?}"));
    }
    tick
}

/// Returns the differences of an output row.
pub(super) fn differences(row: &Json, board: &Released) -> Vec<String> {
    let (mut board, mut found) = (enabled(board), Vec::new());
    board.command("DisableAxis0");
    board.set(&row["parameters"]);
    written_by(&mut board, "EnableAxisDest0 0", row, &mut found);
    let mut per_tick = 0.0;
    for (tick, values) in list(&row["rows"]).iter().enumerate() {
        board.reach_match();
        drop(board.writes());
        board.poke("Dest", number(&values["Dest"]));
        board.interrupt();
        let place = format!("tick {tick}");
        for name in ["Output", "last_vel"] {
            if !values[name].is_null() && !board.is(0, name, &values[name]) {
                found.push(format!("{place} {name}: {}, recorded {}", board.peek(name), values[name]));
            }
        }
        check_words(&board, &place, values, &mut found);
        if !values["generator_position"].is_null() {
            per_tick = check_generator(&mut board, &place, values, per_tick, &mut found);
            continue;
        }
        let (written, expect) = (board.writes(), of_registers(row, writes(&values["writes"])));
        if written != expect {
            found.push(format!("{place}: writes {written:?}, recorded {expect:?}"));
        }
    }
    board.reach_match();
    written_by(&mut board, "DisableAxis0", row, &mut found);
    found
}
