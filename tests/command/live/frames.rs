//! The page with all that a board has at work: how often it shows a new state.

use std::fs;

use harness::Scratch;
use serde_json::Value;
use tungstenite::Message;

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

#[test]
fn the_page_of_a_kogna_gets_its_sixteen_axes() {
    const PROGRAM: &str = "#include \"KMotionDef.h\"\nmain() { ch12->OutputMode = NO_OUTPUT_MODE; ch12->Vel = 1000; \
                           ch12->Accel = 10000; ch12->Jerk = 100000; EnableAxisDest(12, 0); Move(12, 250); for (;;) \
                           WaitNextTimeSlice(); }\n";
    for (board, axes) in [("kflop-5.3.2", 8), ("kogna-5.3.2", 16)] {
        let folder = Scratch::new(&format!("live-{board}"));
        let program = if axes == 16 { PROGRAM } else { "main() { for (;;) ; }\n" };
        fs::write(folder.path().join("a.c"), program).expect("files can be written");
        let live = Live::start(&folder, &["--board", board, "a.c"]);
        let (mut socket, _) = tungstenite::connect(live.socket()).expect("a page may come");
        socket.send(Message::text(r#"{"do":"rate","frames":60}"#)).expect("it listens");
        let (mut hello, mut at) = (None, None);
        while hello != Some(axes) || at.is_none() {
            match socket.read().expect("it goes on") {
                Message::Text(text) => {
                    let message: Value = serde_json::from_str(&text).expect("it is JSON");
                    hello = message["axes"].as_array().map(Vec::len).or(hello);
                }
                Message::Binary(frame) => {
                    let word =
                        |place: usize| u32::from_le_bytes(frame[place..place + 4].try_into().expect("four"));
                    assert_eq!(word(52), axes as u32 - 8, "{board}");
                    let place = 1728 + 72 * 4;
                    let dest =
                        |frame: &[u8]| f64::from_le_bytes(frame[place..place + 8].try_into().expect("eight"));
                    at = (axes == 8 || dest(&frame) == 250.0).then_some(());
                }
                _ => {}
            }
        }
    }
}
