//! The page of a connected controller: it looks until somebody switches control on.

use harness::Scratch;

use super::Live;
use super::browser::{Browser, Mouse};
use super::page::{axis, press, shows};
use super::panels::assert_accessible;
use crate::serve::Server;

/// Moves an axis, asks a question, and counts without end.
const PROGRAM: &str = "\
#include \"KMotionDef.h\"
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 5000; ch0->Accel = 100000; ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveAtVel(0, 500, 4000);
    while (!CheckDone(0)) ;
    sprintf((char *)gather_buffer, \"%s\", \"Tool in?\");
    persist.UserData[101] = 0;
    persist.UserData[102] = MB_YESNO;
    persist.UserData[100] = PC_COMM_MSG;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
    printf(\"the answer is %d\\n\", persist.UserData[103]);
    for (;;) { persist.UserData[6]++; Delay_sec(0.01); }
}
";

/// The rows of the scope.
const SCOPE: &str = "document.querySelector('#scope').scope.history";

/// Follows other signals.
fn watch(list: &str) -> String {
    format!(
        "(() => {{ const list = document.querySelector('#scope [aria-label=Signals]'); list.value = '{list}'; \
         list.dispatchEvent(new Event('change')); }})()"
    )
}

/// A board at the other end of a link, and the page of it; nothing where there is no browser.
fn page(name: &str) -> Option<(Server, Browser, Live, Scratch)> {
    let browser = Browser::start()?;
    let listen = if cfg!(unix) { ["serve", "--listen", "pty"] } else { ["serve", "--listen", "tcp-raw:0"] };
    let server = Server::start(&format!("{name}-board"), &listen, PROGRAM, 1);
    let folder = Scratch::new(name);
    folder.write("move.c", PROGRAM);
    let live = Live::start(&folder, &["--yes", "--on", &server.places[0], "move.c"]);
    Some((server, browser, live, folder))
}

#[test]
fn a_page_looks_at_a_controller_until_control_is_switched_on() {
    let Some((server, mut browser, live, _folder)) = page("live-connected") else { return };
    browser.open(&live.url);
    // Nothing was loaded, and nothing that acts can be pressed.
    browser.until("document.querySelector('#bar .control input').checked === false");
    browser.until("document.querySelector('#axes .keys').inert && document.querySelector('.prompt').inert");
    browser.until(
        "document.querySelector('#timeline').hidden && document.querySelector('[aria-label=Speed]').hidden",
    );
    press(&mut browser, "Load");
    browser.until(&shows("#notice", "this page only looks at the controller: switch Control on"));
    browser.until(&shows("#source", "compiled; Load loads it"));
    assert_accessible(&mut browser);

    browser.click("#bar .control input");
    browser.until("!document.querySelector('#axes .keys').inert");
    press(&mut browser, "Load");
    browser.until(&shows("#console", "move.c is loaded into thread 1 and started"));
    browser.until(&shows("#source", "a controller does not tell which line it executes"));
    browser.until(&format!("{} === 500", axis("Dest")));
    browser.until(&shows("#threads", "running"));

    // A program in a free thread samples the signals of the scope: about 1,000 times a second, not 20.
    browser.until(&shows("#console", "samples a second, by a program in a free thread"));
    browser.until(&format!("{SCOPE}.count > 1000"));
    browser.until(&format!("{SCOPE}.tick({SCOPE}.count - 1) - {SCOPE}.tick({SCOPE}.count - 101) < 4000"));

    // A box waits for the person at the page.
    browser.until(&shows("#asks", "Tool in?"));
    press(&mut browser, "Yes");
    browser.until(&shows("#console", "the answer is 6"));
    browser.value("document.querySelector('#io details:has(.persist)').open = true");
    browser.until("Number(document.querySelector('[aria-label=\"persist 6\"]').value) > 20");

    browser.value(&watch("dest0, out0, persist6, bit0"));
    browser.until(&format!("{SCOPE}.names.length === 4 && {SCOPE}.count > 200"));
    let last = format!("{SCOPE}.value({SCOPE}.count - 1");
    browser.until(&format!("{last}, 0) === 500 && {last}, 2) > 0 && {last}, 3) === 0"));

    // The axis moves as long as the button is held.
    browser.mouse(Mouse::Press, "[aria-label='Jog + Axis 0']");
    browser.until(&format!("{} > 600", axis("Dest")));
    browser.mouse(Mouse::Release, "[aria-label='Jog + Axis 0']");
    rests(&mut browser);
    // A page that is silent while it holds the button stops it as well.
    browser.value("window.setInterval = () => 1");
    browser.mouse(Mouse::Press, "[aria-label='Jog − Axis 0']");
    browser.until(&shows("#console", "Jog0=-"));
    rests(&mut browser);
    browser.mouse(Mouse::Release, "[aria-label='Jog − Axis 0']");

    press(&mut browser, "STOP");
    browser.until(&shows("#threads", "not running"));
    browser
        .until(&shows("#console", "cc67's sampler in thread 7 was stopped: 20 samples a second from now on"));
    browser.until("document.querySelector('#axes tbody tr').classList.contains('off')");

    // A link that is lost is told at once, and nothing acts any more.
    drop(server);
    browser.until(&shows("#notice", "The controller cannot be reached, and what this page shows is old"));
    browser.until("document.body.classList.contains('lost') && document.querySelector('#axes .keys').inert");
    browser.until("document.querySelector('#axes tbody td[data-label=Dest]').textContent === '–'");
    assert_eq!(browser.complaints(), [""; 0]);
}

/// Waits until the first axis rests.
fn rests(browser: &mut Browser) {
    let cell = axis("Dest");
    browser.until(&format!(
        "(() => {{ const now = {cell}; const is = window.lastDest === now; window.lastDest = now; \
         window.rested = is ? (window.rested ?? 0) + 1 : 0; return window.rested > 15; }})()"
    ));
}
