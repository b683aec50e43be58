//! The page at several sizes, with seven threads and eight axes: what acts is in reach, and panels can be given more room.

use harness::Scratch;

use super::Live;
use super::browser::Browser;
use super::page::shows;
use super::panels::assert_accessible;

const PROGRAM: &str = "\
#include \"KMotionDef.h\"
main()
{
    int i;
    for (i = 0; i < 8; i++) { chan[i].InputMode = NO_INPUT_MODE; chan[i].OutputMode = STEP_DIR_MODE; chan[i].OutputChan0 = i; EnableAxisDest(i, 0); }
    for (;;) WaitNextTimeSlice();
}
";
/// Another thread, which waits.
const OTHER: &str = "#include \"KMotionDef.h\"\nmain() { for (;;) Delay_sec(0.5); }\n";

/// Elements of which some part lies outside the page, or of the panel that shows them.
fn out_of_reach(selector: &str) -> String {
    format!(
        "[...document.querySelectorAll({selector:?})].filter((one) => {{ const r = one.getBoundingClientRect(); \
         const p = (one.closest('section') ?? document.documentElement).getBoundingClientRect(); \
         return !r.width || r.left < p.left - 1 || r.right > p.right + 1 || r.right > innerWidth + 1; }}).length"
    )
}

#[test]
fn what_acts_is_in_reach_at_each_size() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-layout");
    folder.write("first.c", PROGRAM);
    let others: Vec<String> = (2..=7).map(|number| format!("{number}:other{number}.c")).collect();
    for number in 2..=7 {
        folder.write(&format!("other{number}.c"), OTHER);
    }
    let programs: Vec<&str> = std::iter::once("first.c").chain(others.iter().map(String::as_str)).collect();
    let live = Live::start(&folder, &programs);
    browser.resize(1440, 900);
    browser.open(&live.url);
    browser.until(&shows("#threads", "WaitNextTimeSlice"));
    browser.until("document.querySelectorAll('#axes tbody tr:not([hidden])').length === 8");

    // A thread is a line, and all seven are seen.
    browser.until("document.querySelectorAll('.thread').length === 7");
    let lines = "[...document.querySelectorAll('.thread')].every((one) => one.clientHeight < 30)";
    assert_eq!(browser.value(lines), true);
    let seen = "(() => { const body = document.querySelector('#threads .body'); return body.scrollHeight <= body.clientHeight + 1; })()";
    assert_eq!(browser.value(seen), true, "seven threads at 1440 x 900");

    for (width, height) in [(1440, 900), (1024, 768), (900, 500), (390, 760)] {
        browser.resize(width, height);
        browser.until(&format!("innerWidth === {width}"));
        browser.value("document.querySelector('#panels').scrollTop = 1e6, scrollTo(0, 1e6)");
        let top = browser.value("document.querySelector('.stop').getBoundingClientRect().top");
        let top = top.as_f64().expect("a number");
        assert!((0.0..120.0).contains(&top), "STOP is at {top} of {height}");
        assert_eq!(browser.value(&out_of_reach(".stop, #axes tr:not([hidden]) .enable")), 0, "at {width}");
        assert_accessible(&mut browser);
    }
    browser.resize(1440, 900);
    browser.until("innerWidth === 1440");

    // Enable says what it does.
    let enable = "document.querySelector('#axes .enable')";
    assert_eq!(browser.value(&format!("{enable}.textContent")), "Disable");
    browser.click("#axes .enable");
    browser.until(&format!("{enable}.textContent === 'Enable'"));

    let width = "document.querySelector('#scope').clientWidth";
    let before = browser.value(width).as_f64().expect("a number");
    browser.value("document.querySelector('[aria-label=\"Resize Scope\"]').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight' }))");
    browser.until(&format!("Math.abs({width} - {before} - 20) < 3"));
    browser.click("[aria-label='Maximise Scope']");
    browser.until(&format!("{width} > 1400 && !document.querySelector('#axes').clientWidth"));
    browser.value("dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape' }))");
    browser.until(&format!("{width} < 900 && document.querySelector('#axes').clientWidth > 0"));
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}
