//! Script commands with arguments of all kinds, some of them misspelled.

use runtime::commands::{Argument, COMMANDS};

use super::ScenarioWriter;
use crate::cli::commands::compare::random::draw::Draw;

/// Commands that are not generated: they stop or restart the board, wait for data from the PC, need a program, reply
/// with the boards' earlier state, or start motions that last until the next line.
const LEFT_OUT: &[&str] = &[
    "CheckDoneGather",
    "ClearFlashImage",
    "EntryPoint",
    "Execute",
    "Flash",
    "GatherMove",
    "GatherStep",
    "GetGather",
    "GetGatherDec",
    "GetGatherHex",
    "GetInject",
    "GetStatus",
    "Inject",
    "Jog",
    "MoveAtVel",
    "MoveExp",
    "MoveRelAtVel",
    "LoadData",
    "LoadFlash",
    "ProgFlashImage",
    "ReadDiskData",
    "Reboot!",
    "RS232",
    "SetFROwRate",
    "SetFROwRateTemp",
    "SetGatherDec",
    "SetGatherHex",
    "SetRapidFROwRate",
    "SetStartupThread",
    "USB",
    "FPGA",
    "FPGAW",
    "ADC",
    "GetVirtualBits",
    "Echo",
];

/// Generates a scenario.
pub(super) fn draw(writer: &mut ScenarioWriter) {
    let axes = 1 + writer.draw.below(3);
    for axis in 0..axes {
        writer.line(format!("InputMode{axis}=0;OutputMode{axis}=0;EnableAxisDest{axis} 0"));
    }
    for _ in 0..6 + writer.draw.below(8) {
        let line = command(&mut writer.draw);
        let moves = line.to_ascii_lowercase().starts_with("move");
        writer.line(line);
        if moves {
            writer.line("(run 0.4)");
        } else if writer.draw.chance(20) {
            let seconds = writer.draw.magnitude(0.002, 0.05);
            writer.line(format!("(run {seconds:?})"));
        }
    }
    for axis in 0..axes {
        writer.line(format!("Dest{axis}"));
        writer.line(format!("CheckDone{axis}"));
    }
    for line in ["GetStopState", "ExecTime", "CheckDoneBuf"] {
        writer.line(line);
    }
}

fn command(draw: &mut Draw) -> String {
    let known: Vec<_> = COMMANDS.iter().filter(|command| !LEFT_OUT.contains(&command.name)).collect();
    let command = draw.pick(&known);
    let mut line = command.name.to_owned();
    if draw.chance(15) {
        line = if draw.chance(50) { line.to_ascii_uppercase() } else { line.to_ascii_lowercase() };
    }
    let mut is_first = true;
    for argument in command.arguments {
        if draw.chance(2) {
            continue;
        }
        match argument {
            Argument::Assign if draw.chance(30) => return ended(draw, line),
            // Anything else stops the board.
            Argument::End => return line,
            Argument::Assign | Argument::Equals => line += draw.pick(&["=", "=", " = ", "= ", " ="]),
            Argument::OptionalEquals => line += draw.pick(&["=", " ", " = "]),
            Argument::Integer(..)
            | Argument::Numbered(..)
            | Argument::Real
            | Argument::Limited(..)
            | Argument::Hex
            | Argument::OptionalHex => {
                if !is_first || draw.chance(40) {
                    line += draw.pick(&[" ", " ", " ", "  "]);
                }
                line += &value(draw, *argument);
            }
        }
        is_first = false;
    }
    ended(draw, line)
}

/// Appends random text that may follow the arguments of a line.
fn ended(draw: &mut Draw, mut line: String) -> String {
    if draw.chance(10) {
        line += draw.pick(&[" ", " 1", "x", "=", "  2 3", ";Dest0"]);
    }
    line
}

fn value(draw: &mut Draw, argument: Argument) -> String {
    if draw.chance(4) {
        return draw.pick(&["", "-", "+", "abc", "1e9", "-1", "99999", "0.5", "."]).to_owned();
    }
    match argument {
        Argument::Integer(low, high) | Argument::Numbered(low, high, _) => {
            let high = if low == 0 && high == 7 { 2 } else { high };
            if draw.chance(5) { (high + 1).to_string() } else { draw.integer(low, high).to_string() }
        }
        Argument::Limited(low, high) => {
            let high = f64::from(high).min(1e4);
            format!("{}", draw.real(f64::from(low).max(-high), high))
        }
        Argument::Hex | Argument::OptionalHex => {
            let number = draw.real(-10.0, 10.0) as f32;
            format!("{:X}", if draw.chance(80) { number.to_bits() } else { draw.below(256) })
        }
        Argument::Real | Argument::Equals | Argument::OptionalEquals | Argument::Assign | Argument::End => {
            let number = draw.signed(0.001, 100.0);
            if draw.chance(30) { draw.integer(0, 9).to_string() } else { format!("{number}") }
        }
    }
}
