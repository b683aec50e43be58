//! Message and input boxes that programs open: they stay open until somebody answers on the page.

use std::fs;

use harness::{Scratch, cc67};

use super::Live;
use super::browser::Browser;
use super::page::{press, shows};
use super::panels::assert_accessible;

/// Asks two questions, the texts of which come after 2000 words of samples in the gather buffer.
const PROGRAM: &str = "\
#include \"KMotionDef.h\"
#define REQUEST 100
int Ask(int code, char *text)
{
    sprintf((char *)gather_buffer + 8000, \"%s\", text);
    persist.UserData[REQUEST + 1] = 2000;
    persist.UserData[REQUEST + 2] = MB_YESNO;
    persist.UserData[REQUEST] = code;
    while (persist.UserData[REQUEST] > 0)
        WaitNextTimeSlice();
    return persist.UserData[REQUEST];
}
main()
{
    int i;
    for (i = 0; i < 1000; i++)
        gather_buffer[i] = 0.5 * i;
    Ask(PC_COMM_MSG, \"Coolant on?\");
    printf(\"the answer is %d\\n\", persist.UserData[REQUEST + 3]);
    Ask(PC_COMM_INPUT, \"Depth\");
    printf(\"the depth is %.1f\\n\", *(float *)&persist.UserData[REQUEST + 2]);
}
";

#[test]
fn a_question_waits_for_its_answer_and_the_answer_is_part_of_the_test() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-asks");
    folder.write("ask.c", PROGRAM);
    let live = Live::start(&folder, &["ask.c"]);
    browser.open(&live.url);
    browser.until(&shows("#asks", "Coolant on?"));
    browser.until(&shows("#console", "message box: Coolant on?: waiting for an answer"));
    // What has waited so long is not answered by itself.
    browser.until("Number.parseFloat(document.querySelector('#bar .time').textContent) > 1");
    assert_eq!(browser.value(&shows("#console", "the answer is")), false);
    // What threads have used, and when.
    browser.until("document.querySelector('#threads [title^=\"worst stack\"]') !== null");
    browser.until("document.querySelectorAll('#threads .turns span').length > 20");
    browser.value("document.querySelector('.gather').open = true");
    press(&mut browser, "Read gather buffer");
    browser.until(&shows(".gather", "1000 numbers, from 0 to 499.50"));

    assert_accessible(&mut browser);
    press(&mut browser, "No");
    browser.until(&shows("#console", "the answer is 7"));
    browser.until(&shows("#asks", "Depth"));
    assert_accessible(&mut browser);
    browser.value("document.querySelector('[aria-label=Depth]').value = '2.5'");
    press(&mut browser, "OK");
    browser.until(&shows("#console", "the depth is 2.5"));
    browser.until("document.querySelector('#asks').hidden");

    press(&mut browser, "Pause");
    browser.value("document.querySelector('[aria-label=\"Test name\"]').value = 'asked'");
    press(&mut browser, "Save as test");
    browser.until(&shows("#notice", "at the same board times"));
    let stimulus = fs::read_to_string(folder.path().join("asked.stim")).expect("it was written");
    for part in ["answer \"boxes=wait\"", "answer \"msgbox=no\"", "answer \"input=2.5\""] {
        assert!(stimulus.contains(part), "{stimulus}");
    }
    let output = cc67(&folder, ["test", "asked.c"]);
    assert_eq!((output.code, output.stdout.as_str()), (0, "1 passed, 0 failed\n"), "{}", output.stderr);
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}
