//! The output of a command whose messages are shown while it runs.

use std::io::{self, BufRead, BufReader, Read};
use std::process::{Command, Output, Stdio};
use std::thread;

/// Runs a command to its end, and shows each line of its stderr at once.
pub(super) fn output(command: &mut Command, mut show: impl FnMut(&str)) -> io::Result<Output> {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    let out = child.stdout.take().map(|mut out| {
        thread::spawn(move || {
            let mut all = Vec::new();
            out.read_to_end(&mut all).map(|_| all)
        })
    });
    let mut stderr = Vec::new();
    if let Some(pipe) = child.stderr.take() {
        let mut lines = BufReader::new(pipe);
        loop {
            let begun = stderr.len();
            if lines.read_until(b'\n', &mut stderr)? == 0 {
                break;
            }
            show(String::from_utf8_lossy(stderr.get(begun..).unwrap_or_default()).trim_end());
        }
    }
    let status = child.wait()?;
    let joined =
        out.map(|reader| reader.join().unwrap_or_else(|_| Err(io::Error::other("its output was lost"))));
    Ok(Output { status, stdout: joined.transpose()?.unwrap_or_default(), stderr })
}
