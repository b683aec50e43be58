//! Plots: what they show, as pictures and as a page in a browser.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use harness::{Output, Scratch, run_in};

const BINARY: &str = env!("CARGO_BIN_EXE_cc67-under-test");

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

fn cc67(scratch: &Scratch, arguments: &[&str]) -> Output {
    fs::write(scratch.path().join("a.c"), PROGRAM).expect("files can be written");
    run_in(BINARY, scratch.path(), arguments)
}

fn plot(name: &str, picture: &str, more: &[&str]) -> (Scratch, Vec<u8>) {
    let scratch = Scratch::new(&format!("plot-{name}"));
    let output = cc67(&scratch, &[&["run", "--plot", picture, "a.c"], more].concat());
    assert_eq!((output.code, output.stderr.as_str()), (0, ""));
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
fn a_run_is_drawn_with_titles_and_units() {
    let (_, svg) = plot("svg", "a.svg", &[]);
    let texts = texts(&svg);
    for expect in [
        "a.c",
        "axis 0: Dest and Position (units)",
        "Dest 0",
        "Position 0",
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
fn what_is_watched_is_drawn() {
    let (_, svg) = plot("watch", "a.svg", &["--watch", "persist.5,dest0"]);
    let texts = texts(&svg);
    assert!(texts.iter().any(|text| text == "persist5"), "{texts:?}");
    assert!(!texts.iter().any(|text| text.contains("output")), "{texts:?}");
    let output = cc67(&Scratch::new("plot-unknown"), &["run", "--plot", "a.svg", "--watch", "axis9", "a.c"]);
    assert_eq!(output.code, 2);
    assert!(
        output.stderr.starts_with("cc67: `dest9` is no item; there are dest0 to dest7"),
        "{}",
        output.stderr
    );
    let output = cc67(&Scratch::new("plot-form"), &["run", "--plot", "a.gif", "a.c"]);
    let expect = "cc67: a.gif is no picture: its name must end in .svg, .png or .html\n";
    assert_eq!((output.code, output.stderr.as_str()), (2, expect));
}

#[test]
fn a_picture_of_pixels_is_as_large_as_the_drawing() {
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
    assert_eq!(run_in(BINARY, harness::root(), arguments).code, 0);
    let kept = harness::root().join("c-programs/homing/home3.svg");
    // Where it differs, `cp homing.svg c-programs/homing/home3.svg` after a look at it.
    assert!(fs::read(picture).expect("it was written") == fs::read(kept).expect("it is kept"), "{command}");
}

#[test]
fn tables_are_drawn() {
    let scratch = Scratch::new("plot-table");
    fs::write(scratch.path().join("log.csv"), "time,speed\n0,1\n0.5,3\n1,2\n").expect("files can be written");
    assert_eq!(cc67(&scratch, &["plot", "log.csv"]).render(), "---- exit 0\n");
    let texts = texts(&fs::read(scratch.path().join("log.svg")).expect("it was written"));
    for expect in ["log.csv", "speed", "time (s)", "0.5"] {
        assert!(texts.iter().any(|text| text == expect), "`{expect}` is not among {texts:?}");
    }
    fs::write(scratch.path().join("bad.csv"), "a,b\n1,2\n3,x\n").expect("files can be written");
    let expect = "---- stderr\ncc67: bad.csv: line 3: `x` is not a number\n---- exit 2\n";
    assert_eq!(cc67(&scratch, &["plot", "bad.csv"]).render(), expect);
}

/// What a person does to the page: reads a value under the pointer, zooms in, goes back.
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
  panels.dispatchEvent(new WheelEvent("wheel", { clientX: x, deltaY: -100, bubbles: true, cancelable: true }));
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

/// The browser; on a machine without one the test says so, but not where CI promises one.
fn browser() -> Option<PathBuf> {
    let paths = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    let found = paths.iter().map(PathBuf::from).find(|path| path.exists());
    if found.is_none() {
        assert!(std::env::var_os("CI").is_none(), "CI installs a browser");
        eprintln!("no Chromium here: the page is not opened");
    }
    found
}

#[test]
fn the_page_zooms_and_tells_values_in_a_browser() {
    let Some(browser) = browser() else { return };
    let (scratch, page) = plot("page", "a.html", &[]);
    let page = String::from_utf8(page).expect("the page is UTF-8");
    assert!(!page.contains("http://") && !page.contains("https://"), "the page needs nothing else");
    let listener =
        "<head><script>const errors = []; window.onerror = message => errors.push(message);</script>";
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
