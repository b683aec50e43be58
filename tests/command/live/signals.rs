//! The scope's list of signals, names of bits and axes, and text that is not UTF-8.

use std::fs;

use harness::Scratch;

use super::Live;
use super::browser::Browser;
use super::page::shows;

const PROGRAM: &str = "\
#include \"KMotionDef.h\"
#define HOME_X 136
int axis;
// VORSCHUB
main()
{
    for (axis = 0;; axis = (axis + 1) % 3) { if (ReadBit(HOME_X + axis)) printf(\"%d\\n\", axis); WaitNextTimeSlice(); }
}
";
const MACHINE: &str = "\
[axis.0]\nname = \"X\"\n[axis.1]\nname = \"Y\"\n\
[[switch]]\nbit = 137\naxis = 1\nwhen = \"<= -500\"\n";

/// Enters a list of signals.
fn enter(browser: &mut Browser, list: &str) {
    browser.value(&format!(
        "(() => {{ const field = document.querySelector('[aria-label=Signals]'); field.value = {list:?}; \
         field.dispatchEvent(new Event('change')); }})()"
    ));
}

#[test]
fn a_wrong_signal_is_named_and_leaves_the_others() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-signals");
    let source = PROGRAM.replace("VORSCHUB", "Vorschub f\u{fc}r \u{d8} 8");
    let latin1: Vec<u8> = source.chars().map(|one| u8::try_from(one).expect("Latin-1")).collect();
    fs::write(folder.path().join("home.c"), latin1).expect("it can be written");
    folder.write("x.toml", MACHINE);
    let live = Live::start(&folder, &["home.c", "--machine", "x.toml", "--watch", "dest0,nosuch,axis"]);
    browser.open(&live.url);
    let names = "document.getElementById('scope').scope.history.names.join()";
    browser.until(&format!("{names} === 'dest0,axis'"));
    browser.until(&shows("#scope .wrong", "nosuch"));
    browser.until("document.getElementById('scope').scope.history.count > 50");

    // As it is written in a shell.
    enter(&mut browser, "\"dest0,pos0,axis * 2 > 1\"");
    browser.until(&format!("{names} === 'dest0,pos0,axis * 2 > 1'"));
    browser.until("document.querySelector('#scope .wrong').hidden");
    let lanes =
        "document.getElementById('scope').scope.layout.lanes.map(({ signals }) => signals.length).join()";
    browser.until(&format!("{lanes} === '1,1,1'"));
    browser.value(
        "(() => { const lanes = document.querySelector('[aria-label=Lanes]'); lanes.value = 'by axis'; \
         lanes.dispatchEvent(new Event('change')); })()",
    );
    browser.until(&format!("{lanes} === '2,1'"));

    browser.until("document.querySelector('[aria-label=\"HOME_X + 1\"]').title.includes('bit 137')");
    browser.until(&shows("#source", "f\u{fc}r \u{d8} 8"));
    browser
        .until("document.querySelector('[aria-label=\"Z is axis\"]').selectedOptions[0].textContent === '2'");
    let cut = "[...document.querySelectorAll('#path select')].filter((one) => one.scrollWidth > one.clientWidth).length";
    assert_eq!(browser.value(cut), 0);
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}
