//! The timeline: a drag lands under the pointer, and a run that is left by an action in the past is kept.

use harness::Scratch;

use super::Live;
use super::browser::{Browser, Mouse};
use super::page::{PROGRAM, axis, press, shows};
use super::panels::assert_accessible;

/// The place of the timeline's slider on the page: left, width, middle.
fn slider(browser: &mut Browser) -> [f64; 3] {
    let place = browser.value(
        "(() => { const r = document.querySelector('[aria-label=Timeline]').getBoundingClientRect(); \
         return [r.left, r.width, r.top + r.height / 2]; })()",
    );
    [0, 1, 2].map(|index| place[index].as_f64().expect("a number"))
}

#[test]
fn a_drag_lands_where_it_ends_and_the_run_that_is_left_is_kept() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-branches");
    folder.write("home.c", PROGRAM);
    let live = Live::start(&folder, &["home.c", "--watch", "dest0,bit136"]);
    browser.open(&live.url);
    browser.until(&shows("#console", "homing"));
    browser.until(&format!("{} < -40", axis("Dest")));
    browser.click("[aria-label=HOME]");
    browser.until(&shows("#console", "home at 250"));
    press(&mut browser, "Pause");
    browser.until(&shows("#bar", "stopped"));
    let end = "Number(document.querySelector('[aria-label=Timeline]').max)";
    let last = browser.value(end);

    // With a real pointer, from the end to two fifths.
    let [left, width, y] = slider(&mut browser);
    browser.mouse_at(Mouse::Press, left + width * 0.9, y);
    for part in [0.8, 0.6, 0.5, 0.4] {
        browser.mouse_at(Mouse::Move, left + width * part, y);
    }
    browser.mouse_at(Mouse::Release, left + width * 0.4, y);
    browser.until(&shows("#timeline", "in the past"));
    assert_eq!(slider(&mut browser)[..2], [left, width], "the timeline keeps its size");
    let at = "document.querySelector('[aria-label=Timeline]').valueAsNumber";
    browser.until(&format!("Math.abs({at} / {end} - 0.4) < 0.02"));

    // One click in the past: the later run is kept, and comes back whole.
    browser.click("[aria-label=ESTOP]");
    browser.until(&shows("#timeline .left", "Run "));
    browser.until(&format!("!{}", shows("#timeline", "in the past")));
    browser.until(&format!("!{}", shows("#console", "home at 250")));
    assert_accessible(&mut browser);
    browser.click("#timeline .branch button");
    browser.until(&shows("#console", "home at 250"));
    browser.until(&format!("{end} === {last} && {at} === {last}"));
    browser.until(&format!("{} === 250", axis("Dest")));
    browser.until("document.querySelector('[aria-label=ESTOP]').getAttribute('aria-checked') === 'false'");
    let history = "document.getElementById('scope').scope.history";
    browser.until(&format!("{history}.tick({history}.count - 1) > {last} - 20"));

    // The short one is kept now; a person drops it.
    browser.until("document.querySelectorAll('#timeline .branch').length <= 1");
    browser.value(
        "document.querySelectorAll('#timeline .branch button:last-child').forEach((one) => one.click())",
    );
    browser.until("document.querySelectorAll('#timeline .branch').length === 0");
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}
