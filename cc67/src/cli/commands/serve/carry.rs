//! A thread for the only client of the board's link: passes bytes from it to the [dispatcher](super::desk), and back.

use std::io::{ErrorKind, Read, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

use super::desk::DispatcherMessage;
use super::wire::WireClient;

/// The number of bytes on their way to the board from which the client has to wait.
const UNTAKEN: usize = 4096;
/// The interval at which a waiting client checks whether the board has taken bytes.
const PAUSE: Duration = Duration::from_millis(1);

/// A client whose bytes are passed on; dropping it reports its end to the dispatcher.
#[derive(Debug)]
pub(super) struct PluggedClient {
    number: u64,
    dispatcher: Sender<DispatcherMessage>,
    untaken: Arc<AtomicUsize>,
}

/// Informs the dispatcher of a new client of the link.
pub(super) fn plug_client(
    number: u64,
    dispatcher: &Sender<DispatcherMessage>,
    writer: impl Write + Send + 'static,
) -> PluggedClient {
    let (outgoing, inbox) = channel();
    let (unread, untaken) = (Arc::<AtomicUsize>::default(), Arc::<AtomicUsize>::default());
    let client = WireClient { number, outgoing, unread: Arc::clone(&unread), untaken: Arc::clone(&untaken) };
    thread::spawn(move || send(writer, &inbox, &unread));
    // If the dispatcher has ended, sending fails below, too.
    let _ = dispatcher.send(DispatcherMessage::Plugged(client));
    PluggedClient { number, dispatcher: dispatcher.clone(), untaken }
}

impl PluggedClient {
    /// Passes bytes between the client and the dispatcher until the client disconnects.
    pub(super) fn carry(self, mut reader: impl Read) {
        let mut buffer = [0; UNTAKEN];
        loop {
            while self.untaken.load(Ordering::Relaxed) >= UNTAKEN {
                thread::sleep(PAUSE);
            }
            let count = match reader.read(&mut buffer) {
                Ok(0) => break,
                Ok(count) => count,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => break,
            };
            self.untaken.fetch_add(count, Ordering::Relaxed);
            let bytes = buffer.get(..count).unwrap_or_default().to_vec();
            if self.dispatcher.send(DispatcherMessage::Bytes(self.number, bytes)).is_err() {
                break;
            }
        }
    }
}

impl Drop for PluggedClient {
    fn drop(&mut self) {
        // An error means that the dispatcher has already ended.
        let _ = self.dispatcher.send(DispatcherMessage::Unplugged(self.number));
    }
}

fn send(mut writer: impl Write, inbox: &Receiver<Vec<u8>>, unread: &AtomicUsize) {
    while let Ok(bytes) = inbox.recv() {
        let written = writer.write_all(&bytes).and_then(|()| writer.flush());
        unread.fetch_sub(bytes.len(), Ordering::Relaxed);
        if written.is_err() {
            return;
        }
    }
}
