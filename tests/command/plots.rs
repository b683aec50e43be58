//! Plots: what they show, as pictures and as a page in a browser.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use harness::{Output, Scratch, cc67};
use serde_json::{Value, json};

/// Moves axis 0 by 500 and back while bit 46 is high.
const PROGRAM: &str = "\
#include \"KMotionDef.h\"
void MoveTo(double position)
{
    Move(0, position);
    while (!CheckDone(0))
        WaitNextTimeSlice();
}
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = NO_OUTPUT_MODE;
    ch0->Vel = 1000;
    ch0->Accel = 10000;
    ch0->Jerk = 100000;
    EnableAxisDest(0, 0);
    SetBit(46);
    MoveTo(500);
    ClearBit(46);
    MoveTo(0);
}
";

fn run(scratch: &Scratch, arguments: &[&str]) -> Output {
    fs::write(scratch.path().join("a.c"), PROGRAM).expect("files can be written");
    cc67(scratch, arguments)
}

fn plot(name: &str, picture: &str, more: &[&str]) -> (Scratch, Vec<u8>) {
    let scratch = Scratch::new(&format!("plot-{name}"));
    let output = run(&scratch, &[&["run", "--plot", picture, "a.c"], more].concat());
    assert_eq!(output.code, 0, "{}", output.stderr);
    let bytes = fs::read(scratch.path().join(picture)).expect("it was written");
    (scratch, bytes)
}

/// The texts of an SVG picture in their order.
fn texts(svg: &[u8]) -> Vec<String> {
    let svg = String::from_utf8(svg.to_vec()).expect("SVG is UTF-8");
    let parts = svg.split("<text").skip(1).filter_map(|part| part.split_once('>'));
    parts.filter_map(|(_, text)| Some(text.split_once("</text>")?.0.trim().to_owned())).collect()
}

#[test]
fn axes_have_the_names_and_units_of_the_machine_file() {
    let scratch = Scratch::new("plot-names");
    scratch.write("m.toml", "[axis.0]\nname = \"X\"\nunits = \"mm\"\n");
    let output = run(&scratch, &["run", "--machine", "m.toml", "--plot", "a.svg", "a.c"]);
    assert_eq!(output.code, 0, "{}", output.stderr);
    let texts = texts(&fs::read(scratch.path().join("a.svg")).expect("it was written"));
    for expect in ["axis 0 (X): Dest and load (mm)", "Dest X", "load X", "axis 0 (X): velocity (mm/s)"] {
        assert!(texts.iter().any(|text| text == expect), "{expect}: {texts:?}");
    }
}

#[test]
fn a_run_is_drawn_with_titles_and_units() {
    let (_, svg) = plot("svg", "a.svg", &[]);
    let texts = texts(&svg);
    for expect in [
        "a.c",
        "axis 0: Dest and load (units)",
        "Dest 0",
        "load 0",
        "axis 0: velocity (units/s)",
        "1000",
        "bit 46",
        "thread 1",
        "time (s)",
    ] {
        assert!(texts.iter().any(|text| text == expect), "`{expect}` is not among {texts:?}");
    }
}

#[test]
fn a_measured_axis_is_drawn_at_its_measured_position() {
    let scratch = Scratch::new("plot-measured");
    scratch.write("b.c", PROGRAM.replace("NO_INPUT_MODE", "ENCODER_MODE"));
    let output = cc67(&scratch, ["run", "--plot", "b.svg", "--trace", "b.csv", "b.c"]);
    assert_eq!(output.code, 0, "{}", output.stderr);
    let texts = texts(&fs::read(scratch.path().join("b.svg")).expect("it was written"));
    for expect in ["axis 0: Dest and Position (units)", "Position 0", "axis 0: following error (units)"] {
        assert!(texts.iter().any(|text| text == expect), "`{expect}` is not among {texts:?}");
    }
    let table = fs::read_to_string(scratch.path().join("b.csv")).expect("it was written");
    assert!(
        table.starts_with("time,dest0,pos0,out0\n"),
        "a table beside a picture has what it has alone: {table}"
    );
}

#[test]
fn a_picture_in_which_nothing_moves_is_refused() {
    let scratch = Scratch::new("plot-empty");
    scratch.write("b.c", "main() { int i; for (i = 0; i < 1000; i++) ; }\n");
    let output = cc67(&scratch, ["run", "--plot", "b.svg", "b.c"]);
    let expect =
        "cc67: b.svg would be empty: no axis was enabled, no bit changed, and no value was recorded\n";
    assert_eq!((output.code, output.stderr.as_str()), (2, expect));
    assert!(!scratch.path().join("b.svg").exists());
}

#[test]
fn watched_values_are_drawn() {
    let (_, svg) = plot("watch", "a.svg", &["--watch", "persist.5,dest0"]);
    let texts = texts(&svg);
    assert!(texts.iter().any(|text| text == "persist5"), "{texts:?}");
    assert!(!texts.iter().any(|text| text.contains("output")), "{texts:?}");
    let output = run(&Scratch::new("plot-unknown"), &["run", "--plot", "a.svg", "--watch", "axis9", "a.c"]);
    assert_eq!(output.code, 2);
    assert!(
        output.stderr.starts_with("cc67: `dest9` is not an item; known: dest0 to dest7"),
        "{}",
        output.stderr
    );
    let output = run(&Scratch::new("plot-nowhere"), &["run", "--watch", "dest0", "a.c"]);
    let expect = "---- stderr\ncc67: `--watch` says what is shown; `--plot FILE.svg` or `--trace FILE.csv` says where\n---- exit 2\n";
    assert_eq!(output.render(), expect);
    let output = run(&Scratch::new("plot-form"), &["run", "--plot", "a.gif", "a.c"]);
    let expect = "cc67: a.gif is not a picture: its name must end in .svg, .png or .html\n";
    assert_eq!((output.code, output.stderr.as_str()), (2, expect));
}

/// The header and the last line of the table that a run of the program writes with this list.
fn table(name: &str, program: &str, list: &str) -> (String, String) {
    let scratch = Scratch::new(&format!("watch-{name}"));
    fs::write(scratch.path().join("b.c"), program).expect("files can be written");
    let output = run(&scratch, &["run", "--trace", "b.csv", "--watch", list, "b.c"]);
    assert_eq!(output.render(), "---- exit 0\n", "{list}");
    let text = fs::read_to_string(scratch.path().join("b.csv")).expect("it was written");
    let line = |text: Option<&str>| text.expect("a line").to_owned();
    (line(text.lines().next()), line(text.lines().next_back()))
}

/// Counts to 3 while it waits, with variables of several types.
const COUNTER: &str = "\
#include \"KMotionDef.h\"
#define SPINDLE 3
int count;
static double rate = 2.5;
struct { short state; float feed; } tool = { 4, 0.25f };
main()
{
    persist.UserData[5] = 11;
    persist.UserData[6] = rate * tool.state;
    chan[SPINDLE].Dest = 100;
    while (count < 3)
    {
        count++;
        Delay_sec(0.001);
    }
}
";

#[test]
fn expressions_are_watched_with_the_programs_names() {
    let list = "count,count / 2.0,rate*tool.feed,tool.state == 4,chan[SPINDLE].Dest - chan[0].Position,\
                persist.UserData[5] + persist.5,fabs(-rate),(bit46, bit1024 ? 1 : 2)";
    let (names, values) = table("program", COUNTER, list);
    let expect = "time,count,count / 2.0,rate*tool.feed,tool.state == 4,chan[SPINDLE].Dest - chan[0].Position,\
                  persist.UserData[5] + persist.5,fabs(-rate),\"(bit46, bit1024 ? 1 : 2)\"";
    assert_eq!(names, expect);
    assert_eq!(values.split_once(',').expect("a time").1, "3,1.5,0.625,1,100,22,2.5,2");
}

#[test]
fn an_unknown_name_suggests_the_nearest_one() {
    let check = |list: &str, expect: &str| {
        let scratch = Scratch::new("watch-wrong");
        fs::write(scratch.path().join("b.c"), COUNTER).expect("files can be written");
        let output = run(&scratch, &["run", "--trace", "b.csv", "--watch", list, "b.c"]);
        assert_eq!(output.render(), format!("---- stderr\ncc67: {expect}\n---- exit 2\n"), "{list}");
    };
    check("cuont", "`--watch cuont`: `cuont` is not declared; did you mean `count`?");
    check("ch0->Dst", "`--watch ch0->Dst`: `CHAN` has no member `Dst`; did you mean `Dest`?");
    check("count = 1", "`--watch count = 1`: it changes something; an expression that is watched only reads");
    check("2:count", "`--watch 2:count`: there is no program in that thread");
    check("bit4000", "`bit4000` is not an item; known: bit0 to bit2047");
    check("count,,rate", "`--watch` needs names between its commas, such as axis0,bit46,persist.5");
}

#[test]
fn variables_of_an_image_and_of_another_thread_can_be_watched() {
    let scratch = Scratch::new("watch-threads");
    fs::write(scratch.path().join("b.c"), COUNTER).expect("files can be written");
    assert_eq!(run(&scratch, &["build", "b.c", "--thread", "2"]).code, 0);
    let list = "2:count,rate,1:tool.state";
    let arguments = ["run", "--trace", "b.csv", "--watch", list, "1:b.c", "2:b(2).out"];
    assert_eq!(run(&scratch, &arguments).render(), "---- exit 0\n");
    let text = fs::read_to_string(scratch.path().join("b.csv")).expect("it was written");
    assert_eq!(text.lines().next(), Some("time,2:count,rate,1:tool.state"));
    assert!(text.trim_end().ends_with(",3,2.5,4"), "{text}");
}

#[test]
fn watched_bits_are_drawn_as_strips() {
    let (_, svg) = plot("strips", "a.svg", &["--watch", "dest0,bit47,bit1030"]);
    let texts = texts(&svg);
    let bits: Vec<_> = texts.iter().filter(|text| text.starts_with("bit ")).collect();
    assert_eq!(bits, ["bit 47", "bit 1030"]);
}

#[test]
fn a_png_has_the_size_of_the_drawing() {
    let (_, png) = plot("png", "a.png", &[]);
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().expect("four bytes"));
    let (width, height) = (number(16), number(20));
    assert_eq!(width, 1000);
    assert!((400..2000).contains(&height), "{height}");
    let (_, again) = plot("png-again", "a.png", &[]);
    assert_eq!(png, again, "the same run, the same picture");
}

#[test]
fn the_picture_in_the_readme_is_what_its_command_draws() {
    let scratch = Scratch::new("plot-readme");
    let picture = scratch.path().join("home3.svg");
    let readme = fs::read_to_string(harness::root().join("README.md")).expect("there is a README");
    let command = "run --plot homing.svg --watch dest0,dest1,dest2 c-programs/homing/home3.c c-programs/homing/home_switches.c";
    assert!(readme.contains(command), "the README shows another command");
    let file = picture.to_string_lossy().into_owned();
    let arguments = command.split(' ').map(|word| if word == "homing.svg" { &file } else { word });
    assert_eq!(cc67(harness::root(), arguments).code, 0);
    let kept = harness::root().join("c-programs/homing/home3.svg");
    // Where it differs, `cp homing.svg c-programs/homing/home3.svg` after a look at it.
    assert!(fs::read(picture).expect("it was written") == fs::read(kept).expect("it is kept"), "{command}");
}

#[test]
fn tables_are_drawn() {
    let scratch = Scratch::new("plot-table");
    fs::write(scratch.path().join("log.csv"), "time,speed\n0,1\n0.5,3\n1,2\n").expect("files can be written");
    assert_eq!(run(&scratch, &["plot", "log.csv"]).render(), "---- exit 0\n");
    let texts = texts(&fs::read(scratch.path().join("log.svg")).expect("it was written"));
    for expect in ["log.csv", "speed", "time (s)", "0.5"] {
        assert!(texts.iter().any(|text| text == expect), "`{expect}` is not among {texts:?}");
    }
    fs::write(scratch.path().join("bad.csv"), "a,b\n1,2\n3,x\n").expect("files can be written");
    let expect = "---- stderr\ncc67: bad.csv: line 3: `x` is not a number\n---- exit 2\n";
    assert_eq!(run(&scratch, &["plot", "bad.csv"]).render(), expect);
}

#[test]
fn a_saved_trace_is_drawn_as_the_run_itself() {
    let traced = ["--trace", "a.csv", "--trace", "a.vcd", "--watch", "axis0,bit46"];
    let (scratch, svg) = plot("saved", "a.svg", &traced);
    // The title is that of the file, and a table knows no threads.
    let shown = |svg: &[u8]| -> Vec<String> {
        let known = |text: &String| !text.starts_with("a.") && !text.starts_with("thread");
        texts(svg).into_iter().filter(known).collect()
    };
    for saved in ["a.csv", "a.vcd"] {
        assert_eq!(run(&scratch, &["plot", saved, "-o", "saved.svg"]).render(), "---- exit 0\n");
        let picture = fs::read(scratch.path().join("saved.svg")).expect("it was written");
        let headings = |svg: &[u8]| -> Vec<String> {
            shown(svg).into_iter().filter(|text| text.parse::<f64>().is_err()).collect()
        };
        assert_eq!(headings(&picture), headings(&svg), "{saved}");
    }
    fs::write(scratch.path().join("bad.vcd"), "time,a\n1,2\n").expect("files can be written");
    let expect = "---- stderr\ncc67: bad.vcd: this is not a value change dump: `$enddefinitions` is missing\n---- exit 2\n";
    assert_eq!(run(&scratch, &["plot", "bad.vcd"]).render(), expect);
}

/// A visitor of the page: reads a value under the pointer, zooms in, goes back.
const VISITOR: &str = r#"
<script>
const seen = [];
const say = text => seen.push(text);
const at = (name, part, more) => {
  const box = panels.getBoundingClientRect();
  const x = box.left + LEFT + part * (box.width - LEFT - RIGHT);
  panels.dispatchEvent(new MouseEvent(name, Object.assign({ clientX: x, clientY: box.top + 50, bubbles: true }, more)));
};
const wheel = part => {
  const box = panels.getBoundingClientRect();
  const x = box.left + LEFT + part * (box.width - LEFT - RIGHT);
  panels.dispatchEvent(new WheelEvent("wheel", { clientX: x, deltaY: -100, ctrlKey: true, bubbles: true, cancelable: true }));
};
at("mousemove", 0.5);
say(document.querySelector(".heading span").textContent);
say(document.getElementById("cursor").textContent);
wheel(0.5); wheel(0.5); wheel(0.5);
say("zoomed " + ((view[1] - view[0]) / (whole[1] - whole[0])).toFixed(3));
at("dblclick", 0.5);
say("whole " + (view[0] === whole[0] && view[1] === whole[1]));
say("drawn " + [...document.querySelectorAll("canvas")].every(c => c.width > 300 && c.height > 10));
const result = document.createElement("pre");
result.id = "result";
result.textContent = "[" + seen.concat(errors).join("|") + "]";
document.body.appendChild(result);
</script>
</body>"#;

/// The browser; without one the test says so.
fn browser() -> Option<PathBuf> {
    let paths = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    let found = paths.iter().map(PathBuf::from).find(|path| path.exists());
    if found.is_none() {
        eprintln!("no Chromium here: the page is not opened");
    }
    found
}

#[test]
fn the_page_zooms_and_shows_values_in_a_browser() {
    let Some(browser) = browser() else { return };
    let (scratch, page) = plot("page", "a.html", &[]);
    let page = String::from_utf8(page).expect("the page is UTF-8");
    assert!(!page.contains("http://") && !page.contains("https://"), "the page needs nothing else");
    let listener = "<head><script>const errors = []; window.onerror = console.error = message => errors.push(message);</script>";
    let page = page.replacen("<head>", listener, 1).replacen("</body>", VISITOR, 1);
    fs::write(scratch.path().join("visited.html"), page).expect("files can be written");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"])
        .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
        .arg(format!("--user-data-dir={}", scratch.path().join("profile").display()))
        .args(["--window-size=1000,800", "--dump-dom"])
        .arg(format!("file://{}", scratch.path().join("visited.html").display()))
        .output()
        .expect("the browser starts");
    let dom = String::from_utf8_lossy(&output.stdout);
    let result = dom.split("<pre id=\"result\">").nth(1).and_then(|rest| rest.split("</pre>").next());
    let result = result.unwrap_or_else(|| panic!("{dom}\n{}", String::from_utf8_lossy(&output.stderr)));
    let (value, rest) = result.trim_start_matches("[Dest 0 ").split_once("|time (s) ").expect(result);
    let (time, rest) = rest.split_once('|').expect(result);
    // The move of 500 takes 0.7 s: in the middle of the run the axis has just arrived.
    let number = |text: &str| text.parse::<f64>().expect(result);
    assert!((number(value) - 500.0).abs() < 0.01 && (number(time) - 0.7).abs() < 0.005, "{result}");
    assert_eq!(rest, "zoomed 0.512|whole true|drawn true]");
}

#[test]
fn a_race_links_the_slices_of_both_threads_and_marks_those_that_split_a_statement() {
    let scratch = Scratch::new("plot-race");
    for thread in 1..=2 {
        let text = "#include \"KMotionDef.h\"\nmain()\n{\n    int i;\n    for (i = 0; i < 2000; i++)\n        \
                    persist.UserData[40]++;\n}\n";
        scratch.write(&format!("count{thread}.c"), text);
    }
    let arguments = ["--plot", "r.html", "--plot", "r.svg", "1:count1.c", "2:count2.c"];
    let output = cc67(&scratch, [&["run", "--as", "board", "--races"][..], &arguments].concat());
    assert_eq!(output.code, 0, "{}", output.stderr);
    let data = page_data(&scratch, "r.html");
    let links = data["links"].as_array().expect("a list");
    let [link] = links.as_slice() else { panic!("{links:?}") };
    let text = link["text"].as_str().expect("a text");
    assert!(output.stderr.contains(text), "{text}");
    assert!(text.contains("count1.c:6") && text.contains("count2.c:6"), "{text}");
    let strips = data["strips"].as_array().expect("a list");
    let names: Vec<_> = link["strips"]
        .as_array()
        .expect("two")
        .iter()
        .map(|index| &strips[index.as_u64().expect("an index") as usize]["name"])
        .collect();
    assert!(names.contains(&&json!("thread 1")) && names.contains(&&json!("thread 2")), "{names:?}");
    // The thread whose old value is stored was interrupted between its load and its store, before the store was seen.
    let at = link["at"].as_f64().expect("a number");
    let splits = strips.iter().flat_map(|strip| strip["marks"].as_array().expect("a list"));
    let before = splits.filter(|mark| mark[0].as_f64().is_some_and(|instant| instant < at));
    let places: Vec<_> = before.filter_map(|mark| mark[1].as_str()).collect();
    assert!(
        places.iter().any(|place| place.starts_with("interrupted inside the statement at count")),
        "{places:?}"
    );
    let svg = fs::read_to_string(scratch.path().join("r.svg")).expect("it was written");
    assert_eq!(svg.matches("<circle").count(), 2);

    // The fast form splits no statement.
    let output = cc67(&scratch, [&["run", "--races"][..], &arguments].concat());
    assert_eq!(output.code, 0, "{}", output.stderr);
    let data = page_data(&scratch, "r.html");
    let strips = data["strips"].as_array().expect("a list");
    assert!(strips.iter().all(|strip| strip["marks"] == json!([])), "{strips:?}");
}

#[test]
fn a_remark_on_two_lines_of_one_thread_is_no_race() {
    let scratch = Scratch::new("plot-two-lines");
    let program =
        PROGRAM.replace("    MoveTo(500);\n", "    Move(0, 500);\n    Delay_sec(0.1);\n    Move(0, 300);\n");
    scratch.write("b.c", program);
    let output = cc67(&scratch, ["run", "--plot", "b.html", "b.c"]);
    assert!(
        output.stderr.contains("before it has arrived") || output.stderr.contains("Move"),
        "{}",
        output.stderr
    );
    assert_eq!(page_data(&scratch, "b.html")["links"], json!([]));
}

/// The data in a page.
fn page_data(scratch: &Scratch, name: &str) -> Value {
    let page = fs::read_to_string(scratch.path().join(name)).expect("it was written");
    let (_, rest) = page.split_once("type=\"application/json\">").expect("it has data");
    let (data, _) = rest.split_once("</script>").expect("they end");
    serde_json::from_str(&data.replace("<\\/", "</")).expect("they are JSON")
}
