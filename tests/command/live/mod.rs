//! `cc67 live`: the page in a real browser, and clients that mean no good.

mod asks;
mod branches;
mod browser;
mod connected;
mod files;
mod firefox;
mod frames;
mod hostile;
#[cfg(target_os = "linux")]
mod lasting;
mod layout;
mod page;
mod panels;
mod restarts;
mod signals;

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use harness::{Scratch, command};

/// A board that is shown.
pub(super) struct Live {
    child: Child,
    /// The address of its page, with the token.
    url: String,
}

impl Live {
    /// Starts it in a folder; a program that is wrong is a failure of the test.
    pub(super) fn start(folder: &Scratch, arguments: &[&str]) -> Self {
        Self::start_at(folder, "0", arguments)
    }

    /// Starts it in a folder, on a port.
    fn start_at(folder: &Scratch, port: &str, arguments: &[&str]) -> Self {
        let state = folder.path().join(".state");
        let mut child = Command::new(command())
            .args(["live", "--no-open", "--port", port])
            .args(arguments)
            .env("XDG_STATE_HOME", &state)
            .env("LOCALAPPDATA", &state)
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let mut url = String::new();
        let out = child.stdout.take().expect("it is piped");
        BufReader::new(out).read_line(&mut url).expect("it says where the page is");
        assert!(url.starts_with("http://127.0.0.1:") && url.contains("/?token="), "{url:?}");
        Self { child, url: url.trim_end().to_owned() }
    }

    /// Host and port.
    fn host(&self) -> &str {
        let rest = self.url.strip_prefix("http://").expect("it was checked");
        rest.split('/').next().expect("it was checked")
    }

    /// The address of its socket.
    pub(super) fn socket(&self) -> String {
        self.url.replacen("http://", "ws://", 1).replacen("/?", "/socket?", 1)
    }

    /// Ends it; what it has said on standard error.
    fn end(mut self) -> String {
        self.child.kill().expect("it runs");
        let errors = self.child.stderr.take().expect("it is piped");
        let lines = BufReader::new(errors).lines().map_while(Result::ok);
        lines.map(|line| line + "\n").collect()
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
