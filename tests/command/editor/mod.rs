//! `cc67 debug` as editors use it: Microsoft's client for debug adapters, and the types of the protocol.
//!
//! Both are of npm; `.ci/node/install` puts them into `target/node`. Neovim has another client, nvim-dap, which
//! `.ci/nvim-dap` puts into `target/nvim-dap`. What is not there is not used, and the test says so.

use std::fs;
use std::process::Command;

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

#[test]
fn neovim_debugs_two_threads_forwards_and_backwards() {
    let plug_in = root().join("target/nvim-dap");
    let has_neovim = || Command::new("nvim").arg("--version").output().is_ok();
    if !plug_in.join("lua/dap.lua").is_file() || !has_neovim() {
        println!("not run: Neovim or nvim-dap is not there; `.ci/nvim-dap` fetches the plug-in");
        return;
    }
    let scratch = Scratch::new("neovim");
    let here = root().join("tests/command/editor");
    for name in ["one.c", "two.c"] {
        fs::copy(here.join(name), scratch.path().join(name)).expect("files can be copied");
    }
    let folder = scratch.path().canonicalize().expect("it is there");
    let mut neovim = Command::new("nvim");
    neovim.args(["--headless", "-u", "NONE", "-n", "--cmd"]);
    neovim.arg(format!("set rtp^={}", plug_in.display()));
    neovim.arg("-c").arg(format!("luafile {}", here.join("nvim.lua").display()));
    neovim.env("CC67_COMMAND", command()).env("CC67_FOLDER", &folder).current_dir(&folder);
    let session = neovim.output().expect("it starts");
    assert!(session.status.success(), "{}", String::from_utf8_lossy(&session.stderr));
}
