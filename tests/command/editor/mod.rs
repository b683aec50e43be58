//! `cc67 debug` as editors use it: Microsoft's client for debug adapters, and the types of the protocol.
//!
//! Both are of npm; `.ci/node/install` puts them into `target/node`. Where they are not, this is said.

use std::fs;

use harness::{Scratch, command, node_modules, root, run_in};

#[test]
fn an_editor_debugs_two_threads_forwards_and_backwards() {
    let Some(modules) = node_modules("@vscode/debugadapter-testsupport") else { return };
    let scratch = Scratch::new("editor");
    let here = root().join("tests/command/editor");
    for name in ["one.c", "two.c"] {
        fs::copy(here.join(name), scratch.path().join(name)).expect("files can be copied");
    }
    let folder = scratch.path().canonicalize().expect("it is there");
    let session = run_in(
        "node",
        &folder,
        [here.join("client.js").as_os_str(), command().as_ref(), folder.as_os_str(), modules.as_os_str()],
    );
    assert_eq!((session.code, session.stdout.as_str()), (0, ""), "{}", session.stderr);

    // Each message that was sent is what the protocol's types allow.
    let checked = run_in(
        "node",
        &folder,
        [here.join("protocol.js").as_os_str(), folder.as_os_str(), modules.as_os_str()],
    );
    assert_eq!(checked.code, 0, "{}{}", checked.stdout, checked.stderr);
    assert!(checked.stdout.ends_with(" messages, 0 errors\n"), "{}", checked.stdout);
}
