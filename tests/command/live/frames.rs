//! The page with all that a board has at work: how often it shows a new state.

use harness::Scratch;

use super::Live;
use super::browser::Browser;

/// Eight axes that jog to and fro.
const MOVES: &str = "\
#include \"KMotionDef.h\"
main()
{
    int i, turn = 1;
    for (i = 0; i < 8; i++)
    {
        chan[i].InputMode = NO_INPUT_MODE; chan[i].OutputMode = STEP_DIR_MODE; chan[i].OutputChan0 = i;
        chan[i].Vel = 1000; chan[i].Accel = 5000; chan[i].Jerk = 50000;
        EnableAxisDest(i, 0);
    }
    for (;;)
    {
        for (i = 0; i < 8; i++) Jog(i, turn * 100 * (i + 1));
        turn = -turn;
        Delay_sec(0.5);
    }
}
";
/// Another thread, which works.
const WORKS: &str = "#include \"KMotionDef.h\"\nint n;\nmain() { for (;;) { n++; Delay_sec(0.01); } }\n";

/// The least states that the page shows in a second. A usual computer shows all 30 that are sent; this leaves room for
/// one that is busy with other tests.
const LEAST: f64 = 15.0;

#[test]
fn a_page_with_eight_axes_and_seven_threads_shows_many_states_a_second() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-frames");
    folder.write("moves.c", MOVES);
    let others: Vec<String> = (2..=7).map(|number| format!("{number}:works{number}.c")).collect();
    for number in 2..=7 {
        folder.write(&format!("works{number}.c"), WORKS);
    }
    let programs: Vec<&str> = std::iter::once("moves.c").chain(others.iter().map(String::as_str)).collect();
    let live = Live::start(&folder, &programs);
    browser.resize(1440, 900);
    browser.open(&live.url);
    browser.until("document.querySelectorAll('.thread').length === 7");
    browser.until("document.querySelectorAll('#axes tbody tr:not([hidden])').length === 8");
    // States are counted where the numbers of the axes change, frames where the browser draws.
    let counted = "new Promise((done) => { let states = 0, frames = 0; const begin = performance.now(); \
         const axes = document.querySelector('#axes tbody'); \
         const changes = new MutationObserver(() => states++); \
         changes.observe(axes, { subtree: true, childList: true, characterData: true }); \
         const frame = (now) => { frames++; if (now - begin < 5000) { requestAnimationFrame(frame); return; } \
         changes.disconnect(); const seconds = (now - begin) / 1000; done([states / seconds, frames / seconds]); }; \
         requestAnimationFrame(frame); })";
    let counts = browser.value(counted);
    let (states, frames) = (counts[0].as_f64().expect("a number"), counts[1].as_f64().expect("a number"));
    println!("{states:.1} states and {frames:.1} frames a second");
    assert!(states >= LEAST && frames >= LEAST, "{states} states and {frames} frames a second");
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}
