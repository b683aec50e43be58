//! `--explain`: questions that people ask, each answered by one call; and what an unknown word gets.

use std::fs;

use harness::{Scratch, cc67};

/// A question, the word that somebody would type, and what the answer has to contain.
const QUESTIONS: &[(&str, &str, &[&str])] = &[
    (
        "What are the arguments of EnableAxis, and when must it be called?",
        "EnableAxis",
        &["void EnableAxis(int ch)", "0 to 7", "OutputMode", "EnableAxis(0);", "axis-disabled"],
    ),
    (
        "Does Move wait until the axis is there?",
        "Move",
        &["does not wait", "CheckDone", "while (!CheckDone(0))"],
    ),
    ("May printf be called in the call-back?", "printf", &["waits", "queue", "UserCallBack", "128"]),
    ("How long does Delay_sec wait, and in which unit?", "Delay_sec", &["seconds", "Delay_sec(0.1)"]),
    ("Which unit has Vel?", "Vel", &["units/s", "4000", "ch0->Vel", "Vel <0..7>"]),
    ("What is bit 46?", "bit46", &["LED", "output", "SetBit(46)"]),
    (
        "Is bit 136 an input, and what connects a switch to it?",
        "bit136",
        &["Kanalog", "input", "ReadBit(136)", "switch"],
    ),
    ("Why does bit 1030 keep its value?", "bit 1030", &["VirtualBitsEx[0]", "memory"]),
    (
        "What does the console command Pos take?",
        "pos",
        &["Pos <0..7>", "position of an axis", "cc67 console"],
    ),
    (
        "How many threads run at a time, and how long is a slice?",
        "threads",
        &["90 µs", "180 µs", "StartThread"],
    ),
    ("How do I wait?", "time", &["Delay_sec", "WaitNextTimeSlice", "Time_sec"]),
    ("How do I find a home switch?", "homing", &["Jog(", "ReadBit(", "Zero("]),
    ("How do I keep a number over power-off?", "flash", &["persist.UserData", "Flash"]),
    ("Why does nothing move?", "motion", &["OutputMode", "EnableAxis", "Vel"]),
    ("How do I simulate a switch that somebody presses?", "stimulus", &["bit"]),
    ("How do I connect a switch to an axis?", "machine", &["[[switch]]"]),
    (
        "What does the remark undriven-input want from me?",
        "undriven-input",
        &["nothing drives", "-R no-undriven-input"],
    ),
    ("What is the warning idle-loop?", "idle-loop", &["Default: on"]),
    ("How large may a program be?", "limits", &["65,536"]),
    ("What is DC_SERVO_MODE?", "DC_SERVO_MODE", &["2", "OutputMode"]),
    ("What replaces digitalWrite?", "digitalWrite", &["SetBit(46)"]),
    ("How does a program get a number from the PC?", "persist", &["UserData", "SetPersistDec"]),
    ("What do the exit codes mean?", "exit", &["4", "limit", "trap"]),
    ("Which fields has an axis?", "CHAN", &["MaxFollowingError", "InputMode", "units"]),
];

#[test]
fn each_question_is_answered_by_one_explain() {
    let scratch = Scratch::new("questions");
    for (question, word, answers) in QUESTIONS {
        let output = cc67(&scratch, ["--explain", word]);
        assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{question}");
        for answer in *answers {
            assert!(output.stdout.contains(answer), "{question} `{answer}` is not in\n{}", output.stdout);
        }
    }
}

#[test]
fn an_unknown_word_gets_a_suggestion() {
    let scratch = Scratch::new("unknown_words");
    for (word, said) in [
        ("EnabelAxis", "did you mean `EnableAxis`?"),
        ("MaxFolowingError", "did you mean `MaxFollowingError`?"),
        ("undriven-inptu", "did you mean `undriven-input`?"),
        ("homeing", "did you mean `homing`?"),
        ("bit4000", "no such bit: 4000 (0-2047)"),
        ("qqqqqqq", "`cc67 --explain topics` lists them"),
    ] {
        let output = cc67(&scratch, ["--explain", word]);
        assert_eq!((output.code, output.stdout.as_str()), (2, ""), "{word}");
        assert!(output.stderr.contains(said), "{word}: {}", output.stderr);
    }
}

#[test]
fn a_word_without_its_own_page_lists_the_pages_that_mention_it() {
    let scratch = Scratch::new("found_words");
    let output = cc67(&scratch, ["--explain", "encoder"]);
    assert_eq!(output.code, 0, "{}", output.stderr);
    assert!(
        output.stdout.contains("ConfigureSpindle") && output.stdout.contains("InputGain0"),
        "{}",
        output.stdout
    );
}

#[test]
fn every_listed_topic_is_explained() {
    let scratch = Scratch::new("topics");
    let list = cc67(&scratch, ["--explain", "topics"]).stdout;
    let words: Vec<_> = list.lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next()).collect();
    assert!(words.len() >= 20, "{list}");
    for word in words {
        let output = cc67(&scratch, ["--explain", word]);
        assert_eq!(output.code, 0, "{word}: {}", output.stderr);
    }
}

/// The pages of topics and of functions have examples in C: whole programs with `main`, and single statements.
#[test]
fn programs_and_statements_of_the_pages_compile() {
    let scratch = Scratch::new("pages_of_topics");
    let folder = harness::root().join("cc67/src/cli/commands/pages");
    let mut statements = String::new();
    let mut pages: Vec<_> = harness::files(&folder.join("topics"), "md");
    pages.push(folder.join("functions.md"));
    for page in pages {
        let text = fs::read_to_string(&page).expect("pages are UTF-8").replace("\r\n", "\n");
        for block in indented(&text) {
            if !block.contains(';') {
                continue;
            }
            if block.contains("main()") {
                scratch.write("whole.c", format!("#include \"KMotionDef.h\"\n{block}"));
                let output = cc67(&scratch, ["check", "whole.c"]);
                assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{}: {block}", page.display());
            } else {
                statements.push_str(&format!("    {{\n{block}    }}\n"));
            }
        }
    }
    let source = format!("#include \"KMotionDef.h\"\nint mutex;\nmain()\n{{\n{statements}}}\n");
    scratch.write("statements.c", &source);
    let output = cc67(&scratch, ["check", "statements.c"]);
    assert_eq!(output.code, 0, "{}", output.stderr);
    assert_eq!(output.stderr, "");
}

/// The blocks of a page that are indented by four spaces.
fn indented(page: &str) -> Vec<String> {
    let mut blocks = Vec::new();
    let mut open = String::new();
    for line in page.lines().chain([""; 1]) {
        match line.strip_prefix("    ") {
            Some(code) => open.push_str(&format!("{code}\n")),
            None if line.is_empty() && !open.is_empty() => open.push('\n'),
            None => blocks.push(std::mem::take(&mut open)),
        }
    }
    blocks.push(open);
    blocks.retain(|block| !block.trim().is_empty());
    blocks
}
