//! Clients over a named pipe of Windows, through which the vendor's library reaches its server there. Source: wire.md
//! section 7.
//!
//! A message is a single write; the client, which reads bytes, receives the second message only after it has answered
//! the first. A later version of the library sends the length of each message as a separate message before it: it is
//! recognised by its first message, and answered in the same way.
//!
//! A client finds a free instance as soon as the previous client has been answered; if two come at the same time, one
//! of them must try again, as the library does.

use anyhow::Result;

/// The name of a pipe in addresses.
const PIPE: &str = "pipe";
/// The folder of all pipes.
const FOLDER: &str = r"\\.\pipe\";
/// The name of the pipe of the vendor's server.
const VENDORS: &str = "kmotionpipe";

/// The path of the pipe for an address: `pipe`, `pipe:NAME` or the path itself; `None` if the address is not a pipe.
pub(super) fn name(address: &str) -> Option<String> {
    if address == PIPE {
        return Some(format!("{FOLDER}{VENDORS}"));
    }
    let name = address.strip_prefix("pipe:").or_else(|| address.strip_prefix(FOLDER))?;
    Some(format!("{FOLDER}{name}"))
}

#[cfg(windows)]
pub(super) use windows::listen;

/// Returns an error: this system has no such pipes.
#[cfg(not(windows))]
pub(super) fn listen(path: &str, _: &super::listen::ConnectionRouter) -> Result<()> {
    anyhow::bail!("{path} is a named pipe, which only Windows has; a socket or tcp:PORT works here")
}

#[cfg(windows)]
mod windows {
    use std::fs::OpenOptions;
    use std::io::ErrorKind;
    use std::num::NonZeroU32;
    use std::thread;
    use std::time::Duration;

    use anyhow::{Context, anyhow, ensure};
    use cc67_host::seats::Closer;
    use interprocess::os::windows::named_pipe::pipe_mode::Messages;
    use interprocess::os::windows::named_pipe::{
        DuplexPipeStream, PipeListenerOptions, PipeMode, WaitTimeout,
    };
    use recvmsg::{MsgBuf, RecvMsg, RecvResult};

    use super::Result;
    use crate::cli::commands::serve::connection::{ClientConnection, LONGEST, Received};
    use crate::cli::commands::serve::listen::ConnectionRouter;
    use crate::cli::io::terminal;

    /// The size of a pipe's buffers in bytes.
    const BUFFER: u32 = 4096;
    /// The default time for which a client waits for a free instance, in milliseconds.
    const WAIT: NonZeroU32 = NonZeroU32::new(10_000).expect("it is not 0");
    /// The system's error number if all instances of a pipe have a client.
    const BUSY: i32 = 231;
    /// The pause after an instance could not be created, during which no client can connect.
    const PAUSE: Duration = Duration::from_millis(100);

    /// Accepts connections at a pipe in the background.
    pub(in crate::cli::commands::serve) fn listen(path: &str, router: &ConnectionRouter) -> Result<()> {
        // Not all systems with named pipes reject a second server.
        let is_served = match OpenOptions::new().read(true).write(true).open(path) {
            Ok(_) => true,
            Err(error) => error.raw_os_error() == Some(BUSY),
        };
        ensure!(!is_served, "another server listens there");
        let options = PipeListenerOptions::new()
            .path(path)
            .mode(PipeMode::Messages)
            .input_buffer_size_hint(BUFFER)
            .output_buffer_size_hint(BUFFER)
            .wait_timeout(WaitTimeout::from_raw(WAIT.get()));
        let listener = options.create_duplex::<Messages>().map_err(|error| match error.kind() {
            ErrorKind::PermissionDenied => anyhow!("another server listens there"),
            _ => anyhow::Error::new(error).context("cannot listen there"),
        })?;
        terminal::note(&format!("a board is served on {path}"));
        let router = router.clone();
        let accept = move || loop {
            match listener.accept() {
                Ok(stream) => router.enter(PipeConnection { stream, has_lengths: false }),
                Err(_) => thread::sleep(PAUSE),
            }
        };
        thread::Builder::new().spawn(accept).context("there is no thread for it")?;
        Ok(())
    }

    /// A client of a pipe.
    #[derive(Debug)]
    pub(in crate::cli::commands::serve) struct PipeConnection {
        stream: DuplexPipeStream<Messages>,
        /// True if the length of each message is sent as a separate message before it.
        has_lengths: bool,
    }

    impl PipeConnection {
        /// The next write of the client, if it is not too long.
        fn read(&mut self) -> Option<Vec<u8>> {
            let mut buffer = MsgBuf::from(Vec::with_capacity(LONGEST + 1));
            buffer.quota = Some(LONGEST + 1);
            match self.stream.recv_msg(&mut buffer, None) {
                Ok(RecvResult::Fit | RecvResult::Spilled) => Some(buffer.filled_part().to_vec()),
                Ok(RecvResult::EndOfStream | RecvResult::QuotaExceeded(_)) | Err(_) => None,
            }
            .filter(|message| message.len() <= LONGEST)
        }

        fn write(&mut self, bytes: &[u8]) -> Option<()> {
            self.stream.send(bytes).ok().filter(|sent| *sent == bytes.len()).map(drop)
        }

        /// The message that follows its length.
        fn body(&mut self, length: [u8; 2]) -> Received {
            let length = usize::from(u16::from_le_bytes(length));
            self.read().filter(|body| body.len() == length).map_or(Received::Nothing, Received::Message)
        }
    }

    impl ClientConnection for PipeConnection {
        /// The operating system can close a pipe only for the thread that reads from it.
        fn closer(&self) -> Option<Closer> {
            None
        }

        fn limit_wait(&mut self, _: Option<Duration>) {}

        fn receive_first(&mut self) -> Received {
            let Some(first) = self.read() else { return Received::Nothing };
            match <[u8; 2]>::try_from(&first[..]) {
                Ok(length) => {
                    self.has_lengths = true;
                    self.body(length)
                }
                Err(_) => Received::Message(first),
            }
        }

        fn receive(&mut self) -> Received {
            let Some(message) = self.read() else { return Received::Nothing };
            if !self.has_lengths {
                return Received::Message(message);
            }
            <[u8; 2]>::try_from(&message[..]).map_or(Received::Nothing, |length| self.body(length))
        }

        fn send(&mut self, message: &[u8]) -> Option<()> {
            if self.has_lengths {
                self.write(&u16::try_from(message.len()).ok()?.to_le_bytes())?;
            }
            self.write(message)
        }

        fn receive_byte(&mut self) -> Option<u8> {
            self.read().and_then(|message| <[u8; 1]>::try_from(&message[..]).ok()).map(|[byte]| byte)
        }

        fn refuse(&mut self, text: &[u8]) {
            // A disconnected client needs no answer.
            let _ = self.write(text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_names_the_vendors_pipe_or_another_one() {
        assert_eq!(name("pipe").as_deref(), Some(r"\\.\pipe\kmotionpipe"));
        assert_eq!(name("pipe:other").as_deref(), Some(r"\\.\pipe\other"));
        assert_eq!(name(r"\\.\pipe\other").as_deref(), Some(r"\\.\pipe\other"));
        assert_eq!(name("pipes"), None);
        assert_eq!(name("tcp:57777"), None);
    }
}
