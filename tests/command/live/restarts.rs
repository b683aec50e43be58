//! A page that is open while `cc67 live` is started again.

use harness::Scratch;

use super::Live;
use super::browser::Browser;
use super::page::{PROGRAM, axis, shows};

#[test]
fn an_open_page_finds_the_server_that_was_started_again() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = Scratch::new("live-restarts");
    folder.write("home.c", PROGRAM);
    let first = Live::start(&folder, &["home.c"]);
    let (url, port) = (first.url.clone(), first.host().rsplit(':').next().expect("a port").to_owned());
    browser.open(&url);
    browser.until(&shows("#console", "homing"));
    first.end();
    browser.until(&shows("#notice", "Reconnecting"));
    let locked = "['#bar', '#panels'].every((part) => document.querySelector(part).inert)";
    browser.until(locked);

    folder.write("home.c", PROGRAM.replace("homing", "homing again"));
    let second = Live::start_at(&folder, &port, &["home.c"]);
    assert_eq!(second.url, url, "the token is kept for the project");
    browser.until(&shows("#console", "homing again"));
    browser.until(&format!("document.querySelector('#notice').hidden && !({locked})"));
    browser.until(&format!("{} < -40", axis("Dest")));
    second.end();

    // A server of another project says so at the same address, on the open page and after a reload.
    let other = Scratch::new("live-restarts-other");
    other.write("home.c", PROGRAM);
    let third = Live::start_at(&other, &port, &["home.c"]);
    assert_ne!(third.url, url);
    browser.until(&shows("#notice", "open the address that it printed"));
    browser.reload();
    browser.until("document.body.textContent.includes('Open the address that cc67 printed')");
}

#[cfg(unix)]
#[test]
fn the_kept_token_is_readable_for_its_owner_alone() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Scratch::new("live-token");
    folder.write("home.c", PROGRAM);
    let live = Live::start(&folder, &["home.c"]);
    let file = folder.path().join(".state/cc67/pages");
    let token = live.url.split("token=").nth(1).expect("there is one");
    assert!(std::fs::read_to_string(&file).expect("it was written").starts_with(token));
    let mode = std::fs::metadata(&file).expect("it is there").permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}
