//! `cc67 run --profile`: the account is exact, and keeping it changes nothing.

use std::fs;

use harness::{Output, Scratch, cc67, files};

const PROGRAM: &str = "\
#include \"KMotionDef.h\"
double table[10];
void Fill(void)
{
    int i;
    for (i = 0; i < 10; i++)
        table[i] = sqrt(i);
}
main()
{
    Fill();
    Delay_sec(0.5);
    printf(\"%g\\n\", table[9]);
}
";

fn run(scratch: &Scratch, arguments: &[&str]) -> Output {
    fs::write(scratch.path().join("a.c"), PROGRAM).expect("files can be written");
    cc67(scratch, ["run"].iter().chain(arguments))
}

#[test]
fn the_table_names_functions_and_lines_with_their_board_time() {
    let output = run(&Scratch::new("profile-table"), &["--profile", "a.c"]);
    insta::assert_snapshot!(output.render());
}

#[test]
fn the_flame_graph_has_the_functions() {
    let scratch = Scratch::new("profile-flame");
    let output = run(&scratch, &["--profile=a.svg", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "3\n"));
    let picture = fs::read_to_string(scratch.path().join("a.svg")).expect("it was written");
    for name in ["thread 1", "main:12", "Delay_sec"] {
        assert!(picture.contains(name), "{name} is not in the picture");
    }
    assert!(!picture.contains("(waiting)"), "waits would leave no room for anything else");
    let again = Scratch::new("profile-flame-again");
    run(&again, &["--profile=a.svg", "a.c"]);
    assert_eq!(picture, fs::read_to_string(again.path().join("a.svg")).expect("it was written"));
    let output = run(&scratch, &["--profile=a.png", "a.c"]);
    assert_eq!(
        output.render(),
        "---- stderr\ncc67: a flame graph is an SVG picture: `--profile=NAME.svg`\n---- exit 2\n"
    );
}

#[test]
fn profiling_does_not_change_what_a_program_prints() {
    for folder in ["threads", "gather", "motion"] {
        for path in files(&harness::root().join("c-programs").join(folder), "c") {
            let (folder, name) =
                (path.parent().expect("a folder"), path.file_name().expect("a name").to_string_lossy());
            let run = |option: &str| cc67(folder, ["run", "--for", "0.3", option, "--time", &name]);
            assert_eq!(run("--profile").stdout, run("--no-shortcuts").stdout, "{name}");
        }
    }
}

#[test]
fn real_code_has_a_profile_of_true_cycles() {
    let output = run(&Scratch::new("profile-real"), &["--engine", "dsp", "--profile", "a.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "3\n"), "{output:?}");
    let table = &output.stderr;
    for part in ["thread 1: computing", "main", "Delay_sec", "a.c:7", "a.c:13"] {
        assert!(table.contains(part), "{part} is not in\n{table}");
    }
}

#[test]
fn the_profile_of_real_code_shows_callers() {
    let scratch = Scratch::new("profile-callers");
    let source = "#include \"KMotionDef.h\"\ndouble table[200];\nint depth;\n\
                  double Half(double x)\n{\n    int i;\n    for (i = 0; i < 50; i++)\n        depth += i & 3;\n    \
                  return x * 0.5;\n}\nvoid Fill(int n)\n{\n    int i;\n    for (i = 0; i < n; i++)\n        \
                  table[i] = Half(i) + Half(n);\n    if (n > 195)\n        Fill(n - 1);\n}\nmain()\n{\n    \
                  for (;;)\n    {\n        Fill(200);\n        if (depth > 2000)\n            break;\n    }\n    \
                  Half(1);\n}\n";
    scratch.write("a.c", source);
    let output = cc67(&scratch, ["run", "--engine", "dsp", "-O0", "--profile=a.svg", "a.c"]);
    assert_eq!(output.code, 0, "{output:?}");
    let row = |name: &str| {
        let line = output.stderr.lines().find(|line| line.ends_with(&format!("  {name}"))).expect(name);
        let words: Vec<&str> = line.split_whitespace().collect();
        let seconds = |at: usize| {
            let unit = match words[at + 1] {
                "s" => 1.0,
                "ms" => 1e-3,
                _ => 1e-6,
            };
            words[at].parse::<f64>().expect("a number") * unit
        };
        // Nothing of it waits, which is one word.
        (seconds(0), seconds(3))
    };
    let (main, fill, half) = (row("main"), row("Fill"), row("Half"));
    assert!(half.0 == half.1, "Half calls nothing: {half:?}");
    // Recursion counts once; only one call of Half is main's own.
    assert!((fill.1 - fill.0 - half.1).abs() < half.1 * 0.001, "{fill:?} {half:?}");
    assert!((main.1 - main.0 - fill.1).abs() < fill.1 * 0.001, "{main:?} {fill:?}");
    let picture = fs::read_to_string(scratch.path().join("a.svg")).expect("it was written");
    assert!(picture.contains("main:") && picture.contains("Half:"), "calls are towers");
}
