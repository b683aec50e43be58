//! Every limit of the compiler that a source can reach: the message contains its number.

use cc67::limits::{COMPILER, Limit};
use compiler::files::FILE_BYTES;
use harness::{Output, Scratch, cc67};

/// A source that exceeds one limit.
struct Case {
    /// The beginning of the limit's description.
    what: &'static str,
    source: fn(usize) -> String,
}

const CASES: &[Case] = &[
    Case { what: "nested includes", source: |_| "#include \"a.c\"\n".to_owned() },
    Case { what: "nested `#if`", source: |most| "#if 1\n".repeat(most + 1) + &"#endif\n".repeat(most + 1) },
    Case {
        what: "parameters of a macro",
        source: |most| format!("#define M({}) 1\n", list(most + 1, |index| format!("a{index}"))),
    },
    Case {
        what: "nested macro calls",
        source: |most| {
            let (open, close) = ("M(".repeat(most + 1), ")".repeat(most + 1));
            format!("#define M(x) x\nint a = {open}1{close};\n")
        },
    },
    Case {
        what: "tokens expanded from macros",
        source: |_| {
            let levels = (1..24).map(|level| format!("#define M{level} M{0} M{0}\n", level - 1));
            format!("#define M0 ;\n{}M23\n", levels.collect::<String>())
        },
    },
    Case {
        what: "bytes of a token made",
        source: |_| {
            let (open, close) = ("D(".repeat(21), ")".repeat(21));
            format!("#define E(a) a##a\n#define D(a) E(a)\nint {open}a{close};\n")
        },
    },
    Case {
        what: "nested parentheses",
        source: |most| format!("int a = {}1{};\n", "(".repeat(most + 1), ")".repeat(most + 1)),
    },
    Case {
        what: "binary operators in a row",
        source: |most| format!("int a = 1{};\n", "+1".repeat(most + 1)),
    },
    Case {
        what: "values of an initialiser",
        source: |most| format!("char a[{0}] = {{ [0 ... {0} - 1] = 1 }};\n", most + 1),
    },
    Case {
        what: "errors in one stage",
        source: |most| (0..=most).map(|index| format!("int a{index} = b{index};\n")).collect(),
    },
    Case { what: "bytes of an object", source: |most| format!("char a[{}];\n", most + 1) },
    Case {
        what: "bytes of the local variables",
        source: |most| format!("void f(void)\n{{\n  char a[{}];\n  a[0] = 1;\n}}\n", most + 8),
    },
];

fn list(count: usize, item: impl Fn(usize) -> String) -> String {
    (0..count).map(item).collect::<Vec<_>>().join(", ")
}

fn check(limit: &Limit, source: &str) -> Output {
    let scratch = Scratch::new(&format!("limits-{}", limit.number));
    scratch.write("a.c", format!("{source}main() {{ }}\n"));
    cc67(&scratch, ["check", "a.c"])
}

#[test]
fn messages_state_the_limit() {
    for case in CASES {
        let limit = COMPILER.iter().find(|limit| limit.what.starts_with(case.what)).expect("it is listed");
        let output = check(limit, &(case.source)(limit.number as usize));
        assert_eq!(output.code, 1, "{}: {output:?}", limit.what);
        assert!(output.stderr.contains(&limit.number.to_string()), "{}: {}", limit.what, output.stderr);
    }
}

#[test]
fn every_limit_has_a_source_or_a_reason() {
    // Half a gigabyte of source for each is too much for a normal run.
    const TOO_LARGE: [&str; 4] = [
        "files included by one compilation, counting each inclusion",
        "bytes of one source file",
        "bytes of all source files together, counting each inclusion",
        "tokens after preprocessing",
    ];
    for limit in COMPILER {
        let has_case = CASES.iter().any(|case| limit.what.starts_with(case.what));
        assert!(has_case || TOO_LARGE.contains(&limit.what), "{}", limit.what);
    }
}

/// Writes a sparse file that is too large but takes no space on the disk.
fn write_large(scratch: &Scratch, name: &str) {
    let file = std::fs::File::create(scratch.path().join(name)).expect("the folder is writable");
    file.set_len(FILE_BYTES + 1).expect("the disk can");
}

#[test]
fn files_that_are_too_large_are_refused_with_the_number() {
    let scratch = Scratch::new("limits-files");
    write_large(&scratch, "large.txt");
    scratch.write("a.c", "main() { }\n");
    for arguments in [
        &["run", "large.txt"][..],
        &["run", "--machine", "large.txt", "a.c"],
        &["run", "--uart-input", "large.txt", "a.c"],
        &["run", "--stim", "large.txt", "a.c"],
        &["inspect", "large.txt"],
        &["check", "large.txt"],
        &["build", "--firmware", "large.txt", "a.c"],
    ] {
        let output = cc67(&scratch, arguments);
        let expect = format!("cannot read large.txt: it is larger than {FILE_BYTES} bytes");
        assert_eq!(output.code, 2, "{arguments:?}: {output:?}");
        assert!(output.stderr.contains(&expect), "{arguments:?}: {output:?}");
    }
}

#[test]
#[cfg(unix)]
fn a_device_that_never_ends_is_refused_like_a_large_file() {
    let scratch = Scratch::new("limits-device");
    let output = cc67(&scratch, ["inspect", "/dev/zero"]);
    assert_eq!(output.code, 2, "{output:?}");
    assert!(output.stderr.contains(&format!("larger than {FILE_BYTES} bytes")), "{output:?}");
}

#[test]
fn a_program_cannot_read_a_file_of_the_pc_that_is_too_large() {
    let scratch = Scratch::new("limits-pc");
    let source = "main()\n{\n  FILE *f = fopen(\"large.txt\", \"rt\");\n  printf(f ? \"opened\\n\" : \"refused\\n\");\n}\n";
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{source}"));
    write_large(&scratch, "large.txt");
    let output = cc67(&scratch, ["run", "--files", ".", "a.c"]);
    assert_eq!(output.stdout, "refused\n", "{output:?}");
    let expect = format!("the PC cannot read large.txt: it is larger than {} bytes", runtime::FILE_BYTES);
    assert!(output.stderr.contains(&expect), "{output:?}");
}

#[test]
fn a_picture_of_a_long_run_says_what_it_leaves_out() {
    let scratch = Scratch::new("limits-picture");
    let source = "main()\n{\n  ch0->InputMode = NO_INPUT_MODE;\n  ch0->OutputMode = NO_OUTPUT_MODE;\n  EnableAxisDest(0, 0);\n  \
                  Jog(0, 100);\n}\n";
    scratch.write("a.c", format!("#include \"KMotionDef.h\"\n{source}"));
    let options = ["--for", "20", "--plot", "a.svg", "--watch", "dest0"];
    let output = cc67(&scratch, ["run"].into_iter().chain(options).chain(["a.c"]));
    assert_eq!(output.code, 0, "{output:?}");
    let expect = "the picture shows every 2 ticks what was so then: it is made of 200000 samples at most";
    assert!(output.stderr.contains(expect), "{output:?}");
}

#[test]
fn the_command_lists_the_same_limits_as_the_book() {
    let shown = cc67(harness::root(), ["--explain", "limits"]).stdout;
    let book = std::fs::read_to_string(harness::root().join("cc67/book/src/limits.md")).expect("it is there");
    let rows: Vec<Vec<&str>> = book.lines().filter_map(row).collect();
    assert!(rows.len() > 20);
    for cells in rows {
        let [most, what, beyond] = cells[..] else { panic!("{cells:?}") };
        let is_listed = |line: &str| {
            let rest = line.trim_start().strip_prefix(most);
            rest.is_some_and(|rest| rest.trim_start() == format!("{what}: {beyond}"))
        };
        assert!(shown.lines().any(is_listed), "{most} {what}: {beyond}");
    }
}

/// The cells of a table row that begins with a number.
fn row(line: &str) -> Option<Vec<&str>> {
    let cells: Vec<_> = line.strip_prefix("| ")?.strip_suffix(" |")?.split(" | ").collect();
    cells[0].starts_with(|first: char| first.is_ascii_digit()).then_some(cells)
}
