//! `cc67 run --profile`: the use of board time by thread, function and line.
//!
//! The [profiling engine](vm::profile) counts exactly, so a profile is the same each time. The cost of a segment is
//! distributed over its instructions, whose lines are in the image.

mod flame;
mod sampled;
mod table;

pub(crate) use sampled::SampledBoard;

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use anyhow::{Result, bail};
use kmotiondef::firmware::FIRMWARE_FUNCTIONS;
use kmotiondef::{CodeAddr, Cycles, GuestAddr};
use runtime::Board;
use vm::engine::ContextId;
use vm::profile::{ProfilingEngine, Site, SpentTime, segment};

use crate::cli::io::output;

/// The form and file of a profile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum ProfileOutput {
    /// A table.
    Table,
    /// A table, and a flame graph in a file.
    Flame(PathBuf),
}

/// Reads the value of `--profile`.
pub(crate) fn target(text: &str) -> Result<ProfileOutput> {
    if text.is_empty() {
        return Ok(ProfileOutput::Table);
    }
    let path = PathBuf::from(text);
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        bail!("a flame graph is an SVG picture: `--profile=NAME.svg`");
    }
    Ok(ProfileOutput::Flame(path))
}

/// Writes the flame graph if requested, and returns the table.
pub(crate) fn report(board: &Board<ProfilingEngine>, target: &ProfileOutput) -> Result<String> {
    finish(&collect(board), board.now(), target)
}

/// Draws the profile if requested, and returns it as a table.
fn finish(account: &Account, end: Cycles, target: &ProfileOutput) -> Result<String> {
    if let ProfileOutput::Flame(path) = target {
        output::write(path, &flame::draw(account)?)?;
    }
    Ok(table::table(account, end))
}

/// The consumer of processor time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum TimeConsumer {
    /// A thread or the call-back.
    Program(ContextId),
    /// The firmware's own thread.
    Firmware,
    /// Code that cannot be interrupted: the servo.
    Interrupt,
}

/// A line of a function, or a firmware function called from one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct ProfileFrame {
    function: String,
    file: String,
    line: Option<u32>,
}

/// A position in the source with the functions that led to it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct ProfilePlace {
    whose: TimeConsumer,
    /// The calls, the outermost function first.
    frames: Vec<ProfileFrame>,
    /// The firmware function in which the time was spent.
    firmware: Option<String>,
}

/// The time spent at each position.
type Account = BTreeMap<ProfilePlace, SpentTime>;

/// Converts addresses to positions; a segment is converted to its lines.
fn collect(board: &Board<ProfilingEngine>) -> Account {
    let mut account = Account::new();
    for (site, spent) in board.machine().engine().profile().sites() {
        let Some((head, callers)) = site.calls.split_first() else { continue };
        let outer: Vec<ProfileFrame> = callers.iter().rev().flat_map(|call| frames(board, *call)).collect();
        for (at, part) in parts(board, site, *head, spent) {
            let mut frames = outer.clone();
            frames.extend(self::frames(board, at));
            let place = {
                let whose = TimeConsumer::Program(site.context);
                ProfilePlace { whose, frames, firmware: site.firmware.map(firmware_name) }
            };
            let entry = account.entry(place).or_default();
            entry.computing += part.computing;
            entry.waiting += part.waiting;
        }
    }
    let Some(images) = board.machine().images().account() else { return account };
    for (spender, time) in images.spent() {
        let calls: Vec<CodeAddr> = images.calls(spender.callers).collect();
        let outer = calls.iter().rev().flat_map(|call| frames(board, *call));
        let frames = outer.chain(frames(board, spender.at)).collect();
        let place = {
            let whose = TimeConsumer::Program(spender.context);
            ProfilePlace { whose, frames, firmware: spender.firmware.map(firmware_name) }
        };
        let entry = account.entry(place).or_default();
        entry.computing += time.computing;
        entry.waiting += time.waiting;
    }
    account
}

/// The instructions that share the time spent at a site.
fn parts(
    board: &Board<ProfilingEngine>,
    site: &Site,
    head: CodeAddr,
    spent: SpentTime,
) -> Vec<(CodeAddr, SpentTime)> {
    let Some(program) = program_of(board, head) else { return vec![(head, spent)] };
    let costs: Vec<(CodeAddr, u32)> = segment(program, head).collect();
    let call = costs.iter().rev().find(|(at, _)| {
        program.word_at(*at).and_then(|word| program.ops().get(word)).is_some_and(vm::meter::is_call)
    });
    if site.firmware.is_some() {
        return vec![(call.map_or(head, |(at, _)| *at), spent)];
    }
    let total: i64 = costs.iter().map(|(_, cost)| i64::from(*cost)).sum();
    if total == 0 {
        return vec![(head, spent)];
    }
    // Time for a device register beyond the instructions is assigned to the first of them.
    let times = spent.computing.get() / total;
    let rest = spent.computing.get() - times * total;
    let mut parts: Vec<_> = costs
        .iter()
        .map(|(at, cost)| {
            let computing = Cycles::new(times * i64::from(*cost));
            (*at, SpentTime { computing, ..SpentTime::default() })
        })
        .collect();
    if let Some((_, first)) = parts.first_mut() {
        first.computing += Cycles::new(rest);
    }
    parts
}

/// The program whose text contains an address.
fn program_of(board: &Board<ProfilingEngine>, address: CodeAddr) -> Option<&vm::program::Program> {
    let mut programs = kmotiondef::ThreadId::all().filter_map(|thread| board.machine().program(thread));
    programs.find(|program| program.word_at(address).is_some())
}

/// The function at an address, and the function inlined there.
fn frames(board: &Board<ProfilingEngine>, address: CodeAddr) -> Vec<ProfileFrame> {
    let frame = |function: &str, file: &str, line| ProfileFrame {
        function: function.to_owned(),
        file: file.to_owned(),
        line,
    };
    match board.source(address) {
        Some(place) => {
            let around = place.around.map(|function| frame(function, place.file, None));
            around.into_iter().chain([frame(place.function, place.file, place.line)]).collect()
        }
        None => vec![frame(&address.to_string(), "", None)],
    }
}

fn firmware_name(address: GuestAddr) -> String {
    let known = FIRMWARE_FUNCTIONS.iter().find(|function| function.address == address);
    known.map_or_else(|| address.to_string(), |function| function.name.to_owned())
}

impl fmt::Display for TimeConsumer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Program(context) => match context.thread() {
                Some(thread) => write!(f, "thread {thread}"),
                None => f.write_str("call-back"),
            },
            Self::Firmware => f.write_str("the firmware's own thread"),
            Self::Interrupt => f.write_str("the servo and what no interrupt comes into"),
        }
    }
}
