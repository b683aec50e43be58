//! The output of `cc67 inspect`, `diff` and `firmware`.

use harness::{Scratch, cc67, vendor};

#[track_caller]
fn succeed(scratch: &Scratch, arguments: &[&str]) -> String {
    let output = cc67(scratch, arguments);
    assert_eq!((output.code, output.stderr.as_str()), (0, ""), "{arguments:?}: {output:?}");
    output.stdout
}

const PROGRAM: &str = "#include \"KMotionDef.h\"
int table[4] = { 1, 2, 3, 4 };
static int calls;
int sum(int n)
{
  int parts[4], i, all = 0;
  for (i = 0; i < n; i++) parts[i] = table[i];
  for (i = 0; i < n; i++) all += parts[i];
  calls++;
  return all;
}
int (*chosen)(int) = sum;
main()
{
  SetBit(46);
  printf(\"%d\\n\", sum(2) + chosen(3));
}
";

fn built(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("p.c", PROGRAM);
    succeed(&scratch, &["build", "--target", "sim", "p.c"]);
    scratch
}

#[test]
fn an_image_is_shown_with_headers_and_symbols() {
    let scratch = built("inspect-image");
    insta::assert_snapshot!(succeed(&scratch, &["inspect", "p(1).out"]));
}

#[test]
fn lines_calls_stack_and_code_are_shown_on_request() {
    let scratch = built("inspect-parts");
    let parts = ["inspect", "--lines", "--calls", "--stack", "-d=sum", "p(1).out"];
    insta::assert_snapshot!(succeed(&scratch, &parts));
}

#[test]
fn symbols_are_sorted_by_size_and_by_name() {
    let scratch = built("inspect-sort");
    let names = |order: &str| {
        let json = succeed(&scratch, &["inspect", "--json", "--sort", order, "p(1).out"]);
        let json: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
        let symbols = json["symbols"].as_array().expect("a list").clone();
        symbols.iter().map(|symbol| symbol["name"].as_str().expect("a text").to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(names("size")[0], "sum");
    let by_name = names("name");
    assert!(by_name.is_sorted(), "{by_name:?}");
    assert!(by_name.contains(&"calls".to_owned()) && by_name.contains(&"SetBit".to_owned()));
}

#[test]
fn json_has_sections_and_symbols_with_name_address_and_size() {
    let scratch = built("inspect-json");
    let json = succeed(&scratch, &["inspect", "--json", "p(1).out"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
    for list in ["sections", "symbols"] {
        let list = json[list].as_array().expect("a list");
        assert!(!list.is_empty());
        for entry in list {
            assert!(entry["name"].is_string() && entry["address"].is_u64(), "{entry}");
            assert!(entry.get("size").is_some(), "{entry}");
        }
    }
    let table = json["symbols"].as_array().expect("a list").iter().find(|symbol| symbol["name"] == "table");
    assert_eq!(table.expect("the object is listed")["size"], 16);
}

#[test]
fn recursion_has_no_worst_chain() {
    let scratch = Scratch::new("inspect-recursive");
    scratch.write("r.c", "int f(int n) { return n ? f(n - 1) : 0; }\nmain() { return f(3); }\n");
    succeed(&scratch, &["build", "--target", "sim", "r.c"]);
    let text = succeed(&scratch, &["inspect", "--stack", "r(1).out"]);
    assert!(text.contains("worst chain: unknown: `f` → `f` is recursive"), "{text}");
}

#[test]
fn code_for_the_controller_is_shown_with_stack_calls_and_cycles() {
    let scratch = Scratch::new("inspect-code");
    scratch.write("p.c", PROGRAM);
    succeed(&scratch, &["build", "-O0", "p.c"]);
    let text = succeed(&scratch, &["inspect", "--calls", "--stack", "p(1).out"]);
    assert!(
        text.contains("main\n  calls sum\n  through pointers sum\n  firmware SetBit, printf\n"),
        "{text}"
    );
    let frame = |name: &str| {
        let row = text.lines().find(|line| line.ends_with(&format!("  {name}"))).expect("a row");
        row.split_whitespace().next().and_then(|bytes| bytes.parse::<u32>().ok()).expect("bytes")
    };
    let (main, sum) = (frame("main"), frame("sum"));
    assert!(sum >= 16, "an array of four integers: {text}");
    let worst = format!("worst chain: main ({main}) → printf (up to 945) = {} of 1776 bytes\n", main + 945);
    assert!(text.contains(&worst), "{text}");
    let listing = succeed(&scratch, &["inspect", "-d=sum", "p(1).out"]);
    let head = listing.lines().find(|line| line.starts_with("sum: ;")).expect("a head");
    assert!(head.contains(&format!("{sum} of stack, ")), "{head}");
}

#[test]
fn an_image_of_the_vendors_compiler_shows_its_parts() {
    let scratch = Scratch::new("inspect-vendor");
    scratch.write("tiny(1).out", vendor::image());
    let text = succeed(&scratch, &["inspect", "--headers", "--lines", "-d", "tiny(1).out"]);
    insta::assert_snapshot!(text);
    let symbols = succeed(&scratch, &["inspect", "--symbols", "tiny(1).out"]);
    for line in [
        "80050020       92 .text    function  main in tiny.c\n",
        "80050080        - .data    object    count\n",
        "800500a0        - -        object    total\n",
        "80050000        - .text    label     helper (static)\n",
        "SetBit\n",
    ] {
        assert!(symbols.contains(line), "{line:?} in:\n{symbols}");
    }
}

#[test]
fn cycles_of_functions_and_loops_are_counted_in_the_code() {
    let scratch = Scratch::new("cycles");
    let source = "#include \"KMotionDef.h\"
int total(int *a, int n)
{
  int i, s = 0;
  for (i = 0; i < n; i++) s += a[i];
  return s;
}
int a[4];
main()
{
  for (;;) {
    WaitNextTimeSlice();
    persist.UserData[0] = total(a, 4);
  }
}
";
    scratch.write("p.c", source);
    succeed(&scratch, &["build", "p.c", "--asm"]);
    let listing = std::fs::read_to_string(scratch.path().join("p(1).asm")).expect("it is written");
    for part in ["main: ; 800500", "; p.c:5: for (i = 0; i < n; i++) s += a[i];", " LDW .D", "; loop, "] {
        assert!(listing.contains(part), "{part:?} in:\n{listing}");
    }
    let table = succeed(&scratch, &["cycles", "p.c"]);
    assert_eq!(table, succeed(&scratch, &["cycles", "p(1).out"]), "of the source and of the image");
    assert!(listing.starts_with(&table), "the listing begins with the table:\n{listing}");
    for part in ["an iteration of the loop at line 5\n", ", without WaitNextTimeSlice\n", "main, "] {
        assert!(table.contains(part), "{part:?} in:\n{table}");
    }
    let output = cc67(&scratch, ["build", "--target", "sim", "--asm", "p.c"]);
    assert!(output.code != 0 && output.stderr.contains("`--asm` needs the controller's code"), "{output:?}");
}

#[test]
fn a_loop_that_is_too_much_work_to_pipeline_is_built_without_and_the_listing_says_so() {
    let scratch = Scratch::new("inspect-exceeded");
    let section = |n: usize| format!("        y = y * 0.5 + x[{n}];\n        x[{n}] = y;\n");
    let sections: String = (0..10).map(section).collect();
    let source = format!(
        "double x[20], y;\nint n;\nmain()\n{{\n    int i;\n    for (i = 0; i < n; i++) {{\n{sections}    }}\n}}\n"
    );
    scratch.write("filter.c", &source);
    succeed(&scratch, &["build", "-O2", "filter.c", "--asm"]);
    let listing = std::fs::read_to_string(scratch.path().join("filter(1).asm")).expect("it is written");
    let line = "filter.c:6: loop scheduled without pipelining: the search exceeded its work limit\n";
    assert!(listing.contains(line), "{listing}");
}

#[test]
fn a_firmware_file_is_shown_with_its_28_sections() {
    let scratch = Scratch::new("inspect-firmware");
    scratch.write("DSPKFLOP.out", vendor::board_firmware());
    let text = succeed(&scratch, &["inspect", "--headers", "DSPKFLOP.out"]);
    assert!(text.contains(" 28 .cio") && text.contains("  4 .debug_abbrev"), "{text}");
    let symbols = succeed(&scratch, &["inspect", "--symbols", "DSPKFLOP.out"]);
    assert!(symbols.contains("_VersionAndBuildTime\n") && symbols.contains("_OnlyInTheFile\n"));
}

#[test]
fn the_difference_of_two_images_is_shown_by_name() {
    let scratch = built("diff");
    scratch.write("q.c", PROGRAM.replace("{ 1, 2, 3, 4 }", "{ 1, 2, 3, 5 }").replace("calls", "count"));
    succeed(&scratch, &["build", "--target", "sim", "q.c", "-o", "q.out"]);
    assert_eq!(succeed(&scratch, &["diff", "p(1).out", "p(1).out"]), "");
    let output = cc67(&scratch, ["diff", "p(1).out", "q.out"]);
    assert_eq!(output.code, 1);
    for part in [
        "section .data: 1 bytes differ, the first at offset 0xc\n",
        "`calls`: only in the first\n",
        "`count`: only in the second\n",
    ] {
        assert!(output.stdout.contains(part), "{part:?} in:\n{}", output.stdout);
    }
}

#[test]
fn the_firmware_is_listed_for_people_and_tools() {
    let scratch = Scratch::new("firmware-list");
    let text = succeed(&scratch, &["firmware", "list"]);
    assert!(text.starts_with("KFLOP 4.34") && text.contains("void SetBit(int "), "{text}");
    let json = succeed(&scratch, &["firmware", "list", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
    assert!(json["functions"].as_array().is_some_and(|list| list.len() > 100));
    assert!(json["variables"].as_array().is_some_and(|list| list.len() > 50));
}

const DEEP: &str = r#"#include "KMotionDef.h"
int table[3];
int leaf(int n) { return n * 3; }
int (*pointed)(int) = leaf;
void fill(int *to, int n) { volatile int some[40]; some[n] = n; to[0] = some[n]; }
main()
{
    int many[100];
    fill(many, 2);
    printf("%d %d\n", many[0], pointed(table[1]));
}
"#;

#[test]
fn the_stack_size_on_the_controller_matches_the_code() {
    let scratch = Scratch::new("inspect-real-stack");
    scratch.write("deep.c", DEEP);
    let text = succeed(&scratch, &["check", "--stack", "deep.c"]);
    insta::assert_snapshot!(text);
    succeed(&scratch, &["build", "deep.c"]);
    assert_eq!(succeed(&scratch, &["inspect", "--stack", "deep(1).out"]), text);
    let calls = succeed(&scratch, &["inspect", "--calls", "deep(1).out"]);
    assert!(calls.contains("main\n  calls fill\n  through pointers leaf\n  firmware printf\n"), "{calls}");
}

#[test]
fn recursion_on_the_controller_names_the_cycle() {
    let scratch = Scratch::new("inspect-real-recursion");
    scratch.write(
        "f.c",
        "int f(int n) { return n > 1 ? f(n - 1) * n + f(n - 2) : 1; }\nmain() { return f(3); }\n",
    );
    let text = succeed(&scratch, &["check", "--stack", "f.c"]);
    assert!(text.contains("worst chain: unknown: `f` → `f` is recursive\n"), "{text}");
}
