//! Every option of every command changes something there, or is refused: no option is accepted and does nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use harness::{Output, Scratch, cc67, cc67_with_input};

use super::boot::firmware;

/// Prints, and writes to a file, what options change.
const PROGRAM: &str = include_str!("options/p.c");

/// The files of each trial.
const FILES: &[(&str, &str)] = &[
    ("p.c", PROGRAM),
    ("p.expected", "x\n"),
    ("q.c", "#include \"KMotionDef.h\"\nmain() { persist.UserData[9]++; for (;;) WaitNextTimeSlice(); }\n"),
    ("i.c", "#include \"KMotionDef.h\"\nmain() { persist.UserData[5] = 77; }\n"),
    ("m.toml", "[[event]]\nat = 0.01\nset_bit = { 48 = 1 }\n"),
    ("inc/v.h", "\n"),
    ("a.csv", "t,x\n0,1\n1,2\n2,4\n"),
    ("d.cmd", "break counted\ncontinue\nprint n\nfinish\ncontinue\n"),
    ("e.cmd", "continue\n"),
    ("host.txt", "request.2=-4\n"),
    ("in.txt", "abc"),
];

/// The command of each trial: its words, and its standard input.
const COMMANDS: &[(&str, &[&str], &str)] = &[
    ("run", &["p.c", "--for", "0.15"], ""),
    ("debug", &["p.c", "--batch", "d.cmd", "--for", "0.15"], ""),
    ("console", &["p.c", "--for", "0.15"], "SetBit46\nReadBit46\n"),
    ("build", &["p.c"], ""),
    ("check", &["p.c"], ""),
    ("cycles", &["p.c"], ""),
    ("inspect", &["p(1).out"], ""),
    ("plot", &["a.csv"], ""),
    ("test", &["p.c"], ""),
    ("init", &["new"], ""),
    ("examples", &["biquad"], ""),
];

/// Commands without trials, each with the reason.
const WITHOUT_TRIALS: &[(&str, &str)] = &[
    ("boards", "what it shows depends on the computer; `command/controller.rs` tests it"),
    ("flash", "it needs a controller; `command/controller.rs` tests it"),
    ("live", "what it shows is in a browser; `command/live` tests it there"),
    ("serve", "what it shows is on a socket; `command/serve` tests it there"),
    ("compare", "it needs a firmware file; `command/boot.rs` tests it"),
    ("firmware", "its subcommands have the options; `images/build.rs` tests them"),
    ("diff", "its option names the board of two images"),
    ("doctor", "what it shows depends on the computer; `command/doctor.rs` tests it"),
    ("machine", "its subcommands have the options"),
    ("sweep", "its options are those of the Python package"),
    ("study", "its options are those of the Python package"),
];

/// For each option, of one command or of all: the words that give it, and words that precede it and are in the run
/// without the option, too.
const SAMPLES: &[(&str, &[&str], &[&str])] = &[
    // Options of commands.
    ("--for", &["--for=0.02"], &[]),
    ("--time", &["--time"], &[]),
    ("--json", &["--json"], &[]),
    ("--state", &["--state"], &[]),
    ("--verbose", &["--verbose"], &[]),
    ("--profile", &["--profile"], &[]),
    ("--batch", &["--batch=e.cmd"], &[]),
    ("--dap", &["--dap"], &[]),
    ("--listen", &["--listen=0"], &[]),
    ("console --serve", &["--serve=tcp:0"], &[]),
    ("console --debug", &["--debug=0"], &["--serve=tcp:0"]),
    ("--thread", &["--thread=2"], &[]),
    ("cycles --thread", &["--thread=2"], &["--asm"]),
    ("build --output", &["--output=o.out"], &[]),
    ("-c", &["-c"], &[]),
    ("--map", &["--map"], &[]),
    ("--asm", &["--asm"], &[]),
    ("--download-script", &["--download-script"], &[]),
    ("--form", &["--form=elf"], &["--board=kogna-5.3.2"]),
    ("--emit", &["--emit=map"], &[]),
    ("--stack", &["--stack"], &[]),
    ("--headers", &["--headers"], &[]),
    ("--symbols", &["--symbols"], &[]),
    ("--sort", &["--sort=size"], &[]),
    ("--raw", &["--raw"], &[]),
    ("--lines", &["--lines"], &[]),
    ("--disassembly", &["--disassembly"], &[]),
    ("--sources", &["--sources=inc"], &["-d"]),
    ("inspect --debug", &["--debug"], &[]),
    ("--calls", &["--calls"], &[]),
    ("--all", &["--all"], &[]),
    ("plot --output", &["--output=x.png"], &[]),
    ("--bless", &["--bless"], &[]),
    ("--force", &["--force"], &["--bless"]),
    ("test --engine", &["--engine=dsp"], &["--json"]),
    ("--junit", &["--junit=r.xml"], &[]),
    ("--example", &["--example=homing"], &[]),
    ("--print", &["--print"], &[]),
    // Programs.
    ("--first", &["--first=2:i.c"], &[]),
    ("--load", &["--load=3:q.c"], &[]),
    ("--no-sidecar", &["--no-sidecar"], &[]),
    // The board.
    ("--machine", &["--machine=m.toml"], &[]),
    ("--stim", &["--stim=at 0.01s bit 48 = 1"], &[]),
    ("--set", &["--set=persist.5=7"], &[]),
    ("--assist", &["--assist"], &["--for=3"]),
    ("-R", &["-Rno-thread-empty"], &[]),
    ("--boot", &["--boot=missing.out"], &[]),
    ("--on", &["--on=lpt1"], &[]),
    // Traces and plots.
    ("--trace", &["--trace=t.csv"], &[]),
    ("--trace-bits", &["--trace-bits=b.csv"], &[]),
    ("--trace-packets", &["--trace-packets=k.csv"], &["--target=c67x"]),
    ("--plot", &["--plot=a.svg"], &[]),
    ("--trace-items", &["--trace-items=persist.5"], &["--trace=t.csv"]),
    ("--trace-every", &["--trace-every=7"], &["--trace=t.csv"]),
    // The PC.
    ("--files", &["--files=dir"], &[]),
    ("--uart-input", &["--uart-input=in.txt"], &[]),
    ("--uart-output", &["--uart-output=out.txt"], &[]),
    ("--uart", &["--uart=missing"], &[]),
    ("--host", &["--host=host.txt"], &[]),
    ("--answer", &["--answer=request.2=-3"], &[]),
    ("--mcode", &["--mcode=M110 P1:5"], &[]),
    ("--flash", &["--flash=in.txt"], &[]),
    // The compiler.
    ("-I", &["-Iinc"], &["-DV"]),
    ("-D", &["-DW"], &[]),
    ("-U", &["-U__TINYC__"], &[]),
    ("-O", &["-O0"], &[]),
    ("-W", &["-Werror"], &["-DW"]),
    ("-w", &["-w"], &["-DW"]),
    ("--std", &["--std=c99"], &[]),
    ("--message-format", &["--message-format=short"], &["-DW"]),
    ("--board", &["--board=missing"], &[]),
    ("--firmware", &["--firmware=missing.out"], &[]),
    ("--gc-sections", &["--gc-sections"], &["-O0"]),
    ("--no-gc-sections", &["--no-gc-sections"], &[]),
    // For experts.
    ("--engine", &["--engine=dsp"], &[]),
    ("--board-faults", &["--board-faults"], &["--stim=at 0.05s bit 136 = 1"]),
    ("--timing", &["--timing=fast"], &[]),
    ("--wait-states", &["--wait-states=io9"], &[]),
    ("--target", &["--target=c67x"], &[]),
    ("build --target", &["--target=sim"], &[]),
];

/// Options that leave everything the same, as they promise, each with the reason.
const THE_SAME: &[(&str, &str)] = &[
    ("--no-shortcuts", "the results are the same without shortcuts"),
    ("--realtime", "the results are the same in real time"),
    ("console --fast", "the default from a script"),
    ("--as", "it matters to programs that race; `command/races.rs` tests it"),
    ("--races", "it reports only what is wrong; `command/races.rs` tests it"),
    ("--schedule", "it matters to programs that race; `command/schedules.rs` tests it"),
    ("--schedules", "it matters to programs that race; `command/schedules.rs` tests it"),
    ("--seed", "it matters to programs that race; `command/schedules.rs` tests it"),
    ("--explore", "a test starts runs with it; `command/schedules.rs` tests it"),
    ("--golden", "a test starts runs with it; `command/schedules.rs` tests it"),
    ("--yes", "it matters to a controller; `command/controller.rs` tests it"),
    ("--verify", "it matters to a controller; `command/controller.rs` tests it"),
    ("run --force", "it matters to a controller; `command/controller.rs` tests it"),
    ("debug --force", "it matters to a controller; `command/controller.rs` tests it"),
    ("console --force", "it matters to a controller; `command/controller.rs` tests it"),
    ("test --jobs", "the results are the same with any number of processes"),
];

/// Options that leave the program of the trials the same on a firmware file, too.
const THE_SAME_ON_A_FILE: &[(&str, &str)] = &[
    ("--verbose", "its remarks are of the modelled firmware"),
    ("-R", "its remarks are of the modelled firmware"),
    ("--target", "programs of a firmware file are for the processor anyway"),
];

/// The result of a run.
#[derive(Debug, PartialEq)]
struct Outcome {
    output: Output,
    files: BTreeMap<String, Vec<u8>>,
}

/// Runs a command with additional words in a folder of its own.
fn outcome((command, words, input): (&str, &[&str], &str), more: &[&str]) -> Outcome {
    let scratch = Scratch::new("options");
    for (name, text) in FILES {
        scratch.write(name, text);
    }
    if command == "inspect" {
        assert_eq!(cc67(&scratch, ["build", "p.c"]).code, 0);
    }
    let mut output = cc67_with_input(&scratch, [&[command], words, more].concat(), input);
    let folder = scratch.path().to_string_lossy().into_owned();
    output.stderr = output.stderr.replace(&folder, "");
    let mut files = BTreeMap::new();
    collect(scratch.path(), scratch.path(), &mut files);
    Outcome { output, files }
}

fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(folder).expect("the folder is readable") {
        let path = entry.expect("the entry is readable").path();
        if path.is_dir() {
            collect(root, &path, files);
        } else if let Ok(bytes) = fs::read(&path) {
            let name = path.strip_prefix(root).expect("it is below the root");
            files.insert(name.to_string_lossy().into_owned(), bytes);
        }
    }
}

/// Returns the long names of a command's options, the short one where there is no other.
fn options_of(command: &str) -> Vec<String> {
    let description = cc67::cli::description();
    let command = description.find_subcommand(command).expect("the command exists");
    let names = command.get_arguments().filter(|argument| !argument.is_positional()).filter_map(|argument| {
        let long = argument.get_long().map(|name| format!("--{name}"));
        long.or_else(|| argument.get_short().map(|name| format!("-{name}")))
    });
    names.filter(|name| !["--help", "--explain"].contains(&name.as_str())).collect()
}

/// Returns the row of an option, where one of the command alone precedes one of all commands.
fn row<'a, T>(rows: &'a [T], name: impl Fn(&T) -> &str, command: &str, option: &str) -> Option<&'a T> {
    let own = format!("{command} {option}");
    rows.iter().find(|row| name(row) == own).or_else(|| rows.iter().find(|row| name(row) == option))
}

/// Returns what is wrong with an option of a command; `None` if it has an effect.
fn idle(command: (&str, &[&str], &str), option: &str) -> Option<String> {
    let name = format!("cc67 {} {option}", command.0);
    let Some((_, words, context)) = row(SAMPLES, |row| row.0, command.0, option) else {
        return Some(format!("{name}: `SAMPLES` has no row for it"));
    };
    let without = outcome(command, context);
    let with = outcome(command, &[context, *words].concat());
    if without.output.code == 2 {
        return Some(format!("{name}: refused without it: {}", without.output.stderr));
    }
    (without == with).then(|| format!("{name}: it changes nothing and is not refused"))
}

/// Returns what is wrong with the options of commands, except those that leave everything the same.
fn wrong(commands: &[(&str, &[&str], &str)], least: usize, the_same: &[(&str, &str)]) -> Vec<String> {
    let mut trials = Vec::new();
    for command in commands {
        for option in options_of(command.0) {
            if row(the_same, |row| row.0, command.0, &option).is_none() {
                trials.push((*command, option));
            }
        }
    }
    assert!(trials.len() > least, "only {} options", trials.len());
    let (next, wrong) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                while let Some((command, option)) = trials.get(next.fetch_add(1, Ordering::Relaxed)) {
                    wrong.lock().expect("no trial panics").extend(idle(*command, option));
                }
            });
        }
    });
    wrong.into_inner().expect("no trial panics")
}

#[test]
fn every_option_of_every_command_changes_something_or_is_refused() {
    let wrong = wrong(COMMANDS, 150, THE_SAME);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_option_changes_something_on_a_firmware_file_too_or_is_refused() {
    let Some(file) = firmware() else { return };
    let words = ["p.c", "--boot", &file, "--for", "0.15"];
    let the_same = [THE_SAME, THE_SAME_ON_A_FILE].concat();
    let wrong = wrong(&[("run", &words, "")], 40, &the_same);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_command_is_tried_or_has_a_reason() {
    let tried: BTreeSet<_> = COMMANDS.iter().map(|row| row.0).collect();
    let left_out: BTreeSet<_> = WITHOUT_TRIALS.iter().map(|row| row.0).collect();
    let description = cc67::cli::description();
    for command in description.get_subcommands() {
        let has_options = !options_of(command.get_name()).is_empty();
        let known = tried.contains(command.get_name()) || left_out.contains(command.get_name());
        assert!(known || !has_options, "no trials of the options of `{}`", command.get_name());
    }
}

#[test]
fn an_option_of_other_commands_is_refused_with_their_names() {
    let scratch = Scratch::new("options-elsewhere");
    scratch.write("a.c", "main() {}\n");
    for (words, expect) in [
        (
            &["check", "--timing", "fast", "a.c"][..],
            "`--timing` has no effect in `cc67 check`; it is an option of `cc67 run`",
        ),
        (&["build", "--wait-states=none", "a.c"], "`--wait-states` has no effect in `cc67 build`"),
        (&["test", "--stim", "x", "a.c"], "`cc67 test … -- --stim` passes it to the programs of the tests"),
        (&["debug", "--engine", "native", "a.c"], "invalid value 'native' for '--engine <ENGINE>'"),
        (&["debug", "a.c", "--dap"], "with `--dap` and `--listen` the editor names the programs"),
        (&["run", "a.c", "--as", "firmware"], "invalid value 'firmware' for '--as <FIDELITY>'"),
        (&["run", "--as", "firmware", "none.out", "a.c"], "cannot read none.out"),
    ] {
        let output = cc67(&scratch, words);
        assert_eq!(output.code, 2, "{words:?}: {}", output.stderr);
        assert!(output.stderr.contains(expect), "{words:?}: {}", output.stderr);
    }
}

#[test]
fn help_lists_commands_and_options_in_groups() {
    let scratch = Scratch::new("options-help");
    let overview = cc67(&scratch, ["--help"]).stdout;
    let description = cc67::cli::description();
    for command in description.get_subcommands().filter(|command| command.get_name() != "help") {
        let line = format!("\n  {} ", command.get_name());
        assert!(overview.contains(&line), "`cc67 --help` lacks {}", command.get_name());
        let about = command.get_about().map(ToString::to_string).unwrap_or_default();
        assert!(overview.contains(&about), "`cc67 --help` lacks: {about}");
    }
    assert!(overview.lines().all(|line| line.len() <= 100), "a line of `cc67 --help` is too long");

    let headings =
        ["Options:", "Programs:", "Board:", "Traces and plots:", "PC, files", "Compiler:", "For experts:"];
    for command in ["run", "debug", "live", "serve", "console", "compare"] {
        let help = cc67(&scratch, [command, "--help"]).stdout;
        if help.is_empty() {
            continue;
        }
        let places: Vec<_> =
            headings.iter().filter_map(|heading| help.find(&format!("\n{heading}"))).collect();
        assert!(places.len() >= headings.len() - 1 && places.is_sorted(), "cc67 {command}: {places:?}");
    }
    assert!(!cc67(&scratch, ["check", "--help"]).stdout.contains("For experts"));
}

#[test]
fn explain_is_a_command_and_an_option() {
    let scratch = Scratch::new("options-explain");
    for name in ["EnableAxis", "bit46", "topics"] {
        assert_eq!(cc67(&scratch, ["explain", name]), cc67(&scratch, ["--explain", name]));
    }
    assert_eq!(cc67(&scratch, ["explain"]), cc67(&scratch, ["explain", "topics"]));
}
