//! One session on the page, as a person has it.

use std::fs;
use std::path::Path;

use harness::{Scratch, cc67};
use serde_json::json;

use super::Live;
use super::browser::{Browser, Mouse};

/// Runs to a switch that somebody has to close, and from there to 250.
pub(super) const PROGRAM: &str = "\
#include \"KMotionDef.h\"
#define HOME 136
#define ESTOP 137
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 4000; ch0->Accel = 20000; ch0->Jerk = 200000;
    EnableAxisDest(0, 0);
    printf(\"homing\\n\");
    Jog(0, -400);
    while (!ReadBit(HOME) && !ReadBit(ESTOP)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
    Move(0, 250);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf(\"home at %.0f\\n\", ch0->Dest);
}
";

/// Returns a JavaScript condition: a part of the page contains a text.
pub(super) fn shows(part: &str, text: &str) -> String {
    format!("document.querySelector('{part}').textContent.includes({text:?})")
}

/// The number in a column of the first axis.
pub(super) fn axis(column: &str) -> String {
    format!("Number(document.querySelector('#axes tbody td[data-label={column}]').textContent)")
}

/// The button with a text.
pub(super) fn press(browser: &mut Browser, text: &str) {
    let script = format!(
        "[...document.querySelectorAll('button')].find((one) => one.textContent === {text:?}).setAttribute('data-test', {text:?})"
    );
    browser.value(&script);
    browser.click(&format!("[data-test='{text}']"));
}

#[test]
fn a_session_works_on_the_page() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-page");
    fs::write(folder.path().join("home.c"), PROGRAM).expect("files can be written");
    fs::write(folder.path().join("x.toml"), "[axis.0]\nname = \"X\"\nunits = \"steps\"\n").expect("the same");
    let live = Live::start(&folder, &["home.c", "--machine", "x.toml", "--watch", "dest0,bit136"]);
    browser.open(&live.url);

    // The program runs, and waits for a switch that is clicked.
    browser.until(&shows("#console", "homing"));
    browser.until(&shows("#threads", "ReadBit(HOME)"));
    browser.until(&format!("{} < -40", axis("Dest")));
    browser.click("[aria-label=HOME]");
    browser.until(&shows("#console", "home at 250"));
    browser.until(&format!("{} === 250", axis("Dest")));

    // Jog as long as the button is held.
    browser.mouse(Mouse::Press, "[aria-label='Jog + X']");
    browser.until(&format!("{} > 400", axis("Dest")));
    browser.mouse(Mouse::Release, "[aria-label='Jog + X']");
    browser.until(&format!("{} === 0", axis("Velocity")));
    // A command in the console.
    browser.value("(() => { const field = document.querySelector('[aria-label=Console]'); field.value = 'Dest0=700'; field.form.requestSubmit(); })()");
    browser.until(&format!("{} === 700", axis("Dest")));

    press(&mut browser, "Pause");
    browser.until("document.querySelector('#bar').textContent.includes('stopped')");
    save_as_test(&mut browser, &folder);
    compare_scope(&mut browser, folder.path());
    drag_back(&mut browser);
    edit(&mut browser, folder.path());

    assert_eq!(browser.complaints(), [""; 0]);
    let outside: Vec<_> = browser
        .requests()
        .iter()
        .filter(|url| !url.contains(live.host()) && !url.starts_with("data:") && !url.starts_with("blob:"))
        .collect();
    assert_eq!(outside, [""; 0]);
    assert_eq!(live.end(), "");
}

/// Saves the actions as a test, which `cc67 test` passes.
fn save_as_test(browser: &mut Browser, folder: &Scratch) {
    browser.value("document.querySelector('[aria-label=\"Test name\"]').value = 'homed'");
    press(browser, "Save as test");
    browser.until(&shows("#notice", "at the same board times"));
    let output = cc67(folder, ["test", "homed.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "1 passed, 0 failed\n"), "{}", output.stderr);
    let stimulus = fs::read_to_string(folder.path().join("homed.stim")).expect("it was written");
    for part in ["bit 136 = 1", "command \"Jog0=1000\"", "command \"Jog0=0\"", "command \"Dest0=700\""] {
        assert!(stimulus.contains(part), "{stimulus}");
    }
}

/// The scope shows within one pixel what a run with the same stimulus writes into its trace.
fn compare_scope(browser: &mut Browser, folder: &Path) {
    let seconds = browser.value("document.querySelector('#bar .time').textContent");
    let seconds = seconds.as_str().and_then(|text| text.strip_suffix(" s")).expect("a time").to_owned();
    let arguments = ["run", "--machine", "x.toml", "--stim", "homed.stim", "--for", &seconds];
    let output =
        cc67(folder, arguments.into_iter().chain(["--trace", "t.csv", "--watch", "dest0", "home.c"]));
    assert_eq!(output.code, 0, "{}", output.stderr);
    let trace = fs::read_to_string(folder.join("t.csv")).expect("it was written");
    let rows: Vec<(f64, f64)> = trace
        .lines()
        .skip(1)
        .filter_map(|line| line.split_once(','))
        .filter_map(|(time, value)| Some((time.parse().ok()?, value.parse().ok()?)))
        .collect();
    let points: Vec<_> =
        rows.iter().step_by((rows.len() / 200).max(1)).map(|(time, value)| json!([time, value])).collect();
    assert!(points.len() > 20, "{} points", points.len());
    browser.value("(() => { const span = document.querySelector('[aria-label=\"Time shown\"]'); span.value = '120'; span.dispatchEvent(new Event('change')); })()");
    browser.until("document.getElementById('scope').scope.layout.to - document.getElementById('scope').scope.layout.from > 1e6");
    let script = format!(
        "(() => {{ const {{ scope }} = document.getElementById('scope'); const {{ layout, canvas }} = scope; \
         const scale = devicePixelRatio; const lane = layout.lanes[0]; \
         const picture = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height); \
         const [red, green, blue] = [0x1a, 0x5f, 0xd0]; \
         const isCurve = (x, y) => {{ const at = (y * canvas.width + x) * 4; const d = picture.data; \
           return d[at + 3] > 60 && Math.abs(d[at] - red) + Math.abs(d[at + 1] - green) + Math.abs(d[at + 2] - blue) < 120; }}; \
         return {}.filter(([time, value]) => {{ \
           const x = Math.round(layout.x(time / 90e-6) * scale), y = Math.round(layout.y(lane, value) * scale); \
           for (let dx = -1; dx <= 1; dx++) for (let dy = -1; dy <= 1; dy++) if (isCurve(x + dx, y + dy)) return false; \
           return true; }}); }})()",
        json!(points)
    );
    assert_eq!(browser.value(&script), json!([]), "points of the trace that the scope does not show");
}

/// Back to where the switch was not closed, and on from there: it is clicked after the axis has gone 40 steps, for which
/// it takes more than a tenth of a second, however fast page and board are.
fn drag_back(browser: &mut Browser) {
    browser.value(
        "(() => { const line = document.querySelector('[aria-label=Timeline]'); line.value = '1000'; \
         line.dispatchEvent(new Event('input')); })()",
    );
    browser.until(&shows("#bar .time", "0.090 s"));
    browser.until(&shows("#timeline", "in the past"));
    browser.until("document.querySelector('[aria-label=HOME]').getAttribute('aria-checked') === 'false'");
    browser.until(&format!("{} < 0", axis("Dest")));
    press(browser, "Run");
    browser.until(&format!("!{}", shows("#timeline", "in the past")));
    browser.until(&format!("!{}", shows("#console", "home at 250")));
    browser.click("[aria-label=ESTOP]");
    browser.until(&shows("#console", "home at 250"));
}

/// A mistake is shown in its line; what is right is loaded when one asks for it.
fn edit(browser: &mut Browser, folder: &Path) {
    let file = folder.join("home.c");
    fs::write(&file, PROGRAM.replace("Zero(0)", "Zeroo(0)")).expect("it can be written");
    browser.until(&shows("#source .row.wrong", "Zeroo"));
    fs::write(&file, PROGRAM.replace("homing", "homing again")).expect("it can be written");
    browser.until(&shows("#source", "Reload loads it"));
    let before = browser.value("document.querySelector('#bar .time').textContent");
    press(browser, "Reload");
    browser.until(&shows("#console", "homing again"));
    let after = browser.value("document.querySelector('#bar .time').textContent");
    let seconds = |value: &serde_json::Value| {
        let text = value.as_str().and_then(|text| text.strip_suffix(" s")).expect("a time").to_owned();
        text.parse::<f64>().expect("a number")
    };
    assert!(seconds(&after) >= seconds(&before), "the board goes on");
}
