//! The page in Firefox, in every test run; `CC67_BROWSER=firefox` has all tests of the page there.

use harness::Scratch;

use super::Live;
use super::browser::Browser;
use super::page::{PROGRAM, axis, shows};

#[test]
fn the_page_works_in_firefox() {
    let Some(mut browser) = Browser::firefox() else {
        println!("no Firefox here: the page is not opened in it");
        return;
    };
    let folder = Scratch::new("live-firefox");
    folder.write("home.c", PROGRAM);
    folder.write("x.toml", "[axis.0]\nname = \"X\"\nunits = \"steps\"\n");
    let live = Live::start(&folder, &["home.c", "--machine", "x.toml", "--watch", "dest0,bit136"]);
    browser.open(&live.url);
    browser.until(&shows("#console", "homing"));
    browser.until(&shows("#threads", "ReadBit(HOME)"));
    browser.until(&format!("{} < -40", axis("Dest")));
    browser.value("document.querySelector('[aria-label=HOME]').click()");
    browser.until(&shows("#console", "home at 250"));
    browser.until(&format!("{} === 250", axis("Dest")));
    let is_drawn = "(() => { const canvas = document.querySelector('#scope canvas'); \
        const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height); \
        return data.some((byte) => byte !== 0); })()";
    browser.until(is_drawn);
    assert_eq!(browser.complaints(), [""; 0]);
    assert_eq!(live.end(), "");
}
