//! Panels that a session on the page does not need: encoders as wheels, `persist`, and whether all of it is accessible.

use std::fs;

use harness::{Scratch, node_modules};
use serde_json::json;

use super::Live;
use super::browser::Browser;

const PROGRAM: &str = "\
#include \"KMotionDef.h\"
main()
{
    ch2->InputMode = ENCODER_MODE;
    ch2->InputChan0 = 2;
    persist.UserData[7] = 3;
    for (;;) WaitNextTimeSlice();
}
";

#[test]
fn encoders_turn_and_persist_is_set_and_every_control_has_a_name() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-panels");
    fs::write(folder.path().join("wheel.c"), PROGRAM).expect("files can be written");
    let live = Live::start(&folder, &["wheel.c"]);
    browser.open(&live.url);
    browser.until("document.querySelector('#threads').textContent.includes('WaitNextTimeSlice')");
    browser.value("document.querySelectorAll('details').forEach((one) => { one.open = true; })");
    browser.until("document.querySelector('.persist').innerText.includes('0x00000003')");

    browser.value(
        "document.querySelector('[aria-label=\"encoder 2\"]').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowUp' }))",
    );
    browser.until(
        "[...document.querySelectorAll('#axes tbody tr')].some((row) => row.textContent.includes('Axis 2') && \
         row.querySelector('td[data-label=Position]').textContent === '4')",
    );
    browser.value(
        "(() => { const all = document.querySelector('.persist').closest('details').querySelector('input[type=checkbox]'); \
         all.click(); const field = document.querySelector('[aria-label=\"persist 5\"]'); field.value = '1069547520'; \
         field.dispatchEvent(new Event('change')); })()",
    );
    browser.until("document.querySelector('.persist').innerText.includes('0x3fc00000')");

    assert_accessible(&mut browser);
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}

#[test]
fn a_race_is_shown_at_the_slices_with_links_to_both_lines() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-races");
    for thread in 1..=2 {
        let text = "#include \"KMotionDef.h\"\nmain()\n{\n    for (;;)\n        persist.UserData[40]++;\n}\n";
        fs::write(folder.path().join(format!("count{thread}.c")), text).expect("files can be written");
    }
    let live = Live::start(&folder, &["--as", "board", "--races", "1:count1.c", "2:count2.c"]);
    browser.open(&live.url);
    browser.until("document.querySelectorAll('.races p').length > 0");
    browser.until("document.querySelectorAll('.turns .split').length > 0");
    let title = browser.value("document.querySelector('.turns').title");
    assert!(title.as_str().is_some_and(|title| title.contains("Switched inside a statement: ")), "{title}");
    let links = browser.value("[...document.querySelectorAll('.races p')[0].querySelectorAll('button')].map((one) => one.textContent).sort()");
    assert_eq!(links, json!(["count1.c:5", "count2.c:5"]));

    // Each line has the message with a link to the other one.
    browser.value(
        "[...document.querySelectorAll('.races button')].find((one) => one.textContent === 'count2.c:5').click()",
    );
    browser.until("document.querySelector('#source .message.remark button')?.textContent === 'count1.c:5'");
    browser.value("document.querySelector('#source .message.remark button').click()");
    browser.until("document.querySelector('#source .message.remark button')?.textContent === 'count2.c:5'");

    assert_accessible(&mut browser);
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}

/// axe-core finds no serious fault in what the page shows, where it is installed.
pub(super) fn assert_accessible(browser: &mut Browser) {
    if let Some(modules) = node_modules("axe-core") {
        let axe = fs::read_to_string(modules.join("axe-core/axe.min.js")).expect("the package has it");
        browser.value(&format!("{axe};\ntrue"));
        let faults = browser.value(
            "axe.run().then(({ violations }) => violations.filter(({ impact }) => ['serious', 'critical'].includes(impact)) \
             .map(({ id, nodes }) => `${id}: ${nodes[0].html}`))",
        );
        assert_eq!(faults, json!([]));
    }
}
