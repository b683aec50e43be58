//! Several users of one board: their requests are executed in turn.

use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use crate::client::Client;
use crate::error::WireError;

/// The time for which the console is read at once while there is no request.
const IDLE: Duration = Duration::from_millis(5);

type QueuedRequest = Box<dyn FnOnce(&mut Client) + Send>;

/// A board shared by several users. Each clone is a further user.
#[derive(Clone, Debug)]
pub struct Queue {
    requests: Sender<QueuedRequest>,
}

impl Queue {
    /// Serves requests for a board in a separate thread, until the last user is dropped.
    ///
    /// Between requests, `idle` is called with the client, to take its console lines, or with the error of a lost link.
    #[must_use]
    pub fn new(
        client: Client,
        idle: impl FnMut(&mut Client, Result<(), WireError>) + Send + 'static,
    ) -> Self {
        let (requests, inbox) = channel();
        thread::spawn(move || serve(client, &inbox, idle));
        Self { requests }
    }

    /// Executes a request in its turn, and returns its result.
    ///
    /// # Errors
    /// The previous requests and this one have not ended within the time limit.
    pub fn run<T: Send + 'static>(
        &self,
        within: Duration,
        request: impl FnOnce(&mut Client) -> T + Send + 'static,
    ) -> Result<T, WireError> {
        let (answer, inbox) = channel();
        let job = Box::new(move |client: &mut Client| {
            // The requester may have given up.
            let _ = answer.send(request(client));
        });
        let waited = || WireError::Waiting(within.as_secs_f64());
        self.requests.send(job).map_err(|_| waited())?;
        inbox.recv_timeout(within).map_err(|_| waited())
    }
}

fn serve(
    mut client: Client,
    inbox: &Receiver<QueuedRequest>,
    mut idle: impl FnMut(&mut Client, Result<(), WireError>),
) {
    let mut is_lost = false;
    loop {
        let pause = if is_lost { Duration::from_millis(100) } else { Duration::ZERO };
        match inbox.recv_timeout(pause) {
            Ok(request) => {
                request(&mut client);
                is_lost = false;
            }
            Err(RecvTimeoutError::Timeout) if is_lost => {}
            Err(RecvTimeoutError::Timeout) => {
                let serviced = client.service(IDLE);
                is_lost = serviced.is_err();
                idle(&mut client, serviced);
            }
            Err(RecvTimeoutError::Disconnected) => return,
        }
    }
}
