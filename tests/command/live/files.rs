//! Files that are saved or deleted while their board is shown: sources with errors, the machine file; and a trap.

use std::fs;

use harness::Scratch;

use super::Live;
use super::browser::Browser;
use super::page::{PROGRAM, press, shows};

/// Stores through a pointer to nothing when a switch is closed.
const TRAP: &str = "\
#include \"KMotionDef.h\"
main()
{
    int *nothing = 0;
    printf(\"waits\\n\");
    while (!ReadBit(136)) WaitNextTimeSlice();
    *nothing = 1;
}
";

#[test]
fn errors_are_shown_as_in_the_terminal_and_reload_says_that_nothing_is_loaded() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-files");
    folder.write("home.c", PROGRAM);
    let live = Live::start(&folder, &["home.c"]);
    browser.open(&live.url);
    browser.until(&shows("#console", "homing"));

    folder.write("home.c", PROGRAM.replace("Zero(0)", "Zeroo(0)"));
    browser.until(&shows("#source .head", "home.c:16:5: "));
    // The line, a caret under the word, and help, as the compiler writes them.
    browser.until(&shows("#source .report", "^^^^^"));
    browser.until(&shows("#source .report", "did you mean `Zero`"));
    press(&mut browser, "Reload");
    browser.until(&shows("#notice", "home.c is not loaded: "));
    browser.until(&shows("#console", "home.c is not loaded: "));

    folder.write("home.c", PROGRAM);
    browser.until(&shows("#source", "Reload loads it"));
    fs::remove_file(folder.path().join("home.c")).expect("it is there");
    browser.until(&shows("#source .head", "cannot read home.c"));
    browser.until(&format!("!{}", shows("#source", "Reload loads it")));
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}

#[test]
fn the_machine_file_is_applied_when_it_is_saved_and_the_board_begins_again() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-machine");
    folder.write("home.c", PROGRAM);
    folder.write("x.toml", "[axis.0]\nname = \"X\"\n");
    let live = Live::start(&folder, &["home.c", "--machine", "x.toml"]);
    browser.open(&live.url);
    browser.until(&shows("#console", "homing"));
    browser.until("Number.parseFloat(document.querySelector('#bar .time').textContent) > 0.5");

    folder.write("x.toml", "[axis.0]\nname = \n");
    browser.until(&shows("#timeline .bad", "x.toml:2:8: "));
    press(&mut browser, "Restart");
    browser.until(&shows("#notice", "x.toml:2:8: "));
    folder.write("x.toml", "[axis.0]\nname = \"Tower\"\nunits = \"mm\"\n");
    browser.until(&shows("#timeline", "x.toml is saved: Restart applies it"));
    assert_eq!(browser.value(&shows("#axes", "Tower")), false);
    press(&mut browser, "Restart");
    browser.until(&shows("#axes", "Tower"));
    browser.until(&format!("!{}", shows("#timeline", "Restart applies it")));
    browser.until(&shows("#console", "homing"));
    let once = "document.querySelector('#console').textContent.split('homing').length === 2";
    browser.until(once);

    // The text that the board was made of needs no new one.
    folder.write("x.toml", "[axis.0]\nname = \"Crane\"\n");
    browser.until(&shows("#timeline", "x.toml is saved: Restart applies it"));
    folder.write("x.toml", "[axis.0]\nname = \"Tower\"\nunits = \"mm\"\n");
    browser.until(&format!("!{}", shows("#timeline", "Restart applies it")));
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}

#[test]
fn a_trap_is_a_red_line_with_its_reason() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-trap");
    folder.write("wild.c", TRAP);
    let live = Live::start(&folder, &["wild.c"]);
    browser.open(&live.url);
    browser.until(&shows("#console", "waits"));
    browser.click("[aria-label='bit 136']");
    browser.until(&shows(".thread.trap .badge", "trap"));
    browser.until("document.querySelector('.thread.trap .reason').textContent.length > 10");
    browser.until("document.querySelector('.thread.trap .where').title.startsWith('wild.c:7 in main')");
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}
