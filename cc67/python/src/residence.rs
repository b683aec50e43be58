//! The thread in which a session lives.
//!
//! A session on the interpreter can be used by any thread, one at a time. One with native stacks stays in the thread
//! that made it, so it gets one of its own, to which every call is sent. A call looks the same for both.

use std::sync::mpsc::{Sender, channel};
use std::thread;

use crate::control::Control;

/// A call that is sent to the session's own thread.
type Job = Box<dyn FnOnce(&mut dyn Control) + Send>;

/// A session, wherever it is.
pub(crate) enum Residence {
    /// The calling thread.
    Here(Box<dyn Control + Send>),
    /// In a thread of its own, which ends with this.
    Elsewhere(Sender<Job>),
}

impl Residence {
    /// A session in a thread of its own, made there.
    pub(crate) fn elsewhere<C: Control, F>(
        make: impl FnOnce() -> Result<C, F> + Send + 'static,
    ) -> Option<Result<Self, F>>
    where
        F: Send + 'static,
    {
        let (sender, jobs) = channel::<Job>();
        let (made, result) = channel();
        let body = move || match make() {
            Ok(mut control) => {
                // Nobody waits for an answer that has gone away.
                let _ = made.send(Ok(()));
                jobs.into_iter().for_each(|job| job(&mut control));
            }
            Err(error) => {
                let _ = made.send(Err(error));
            }
        };
        thread::Builder::new().name("cc67 board".to_owned()).spawn(body).ok()?;
        Some(result.recv().ok()?.map(|()| Self::Elsewhere(sender)))
    }

    /// Calls the session; `None` if its thread is gone, which only a bug in cc67 can cause.
    pub(crate) fn call<R: Send + 'static>(
        &mut self,
        work: impl FnOnce(&mut dyn Control) -> R + Send + 'static,
    ) -> Option<R> {
        match self {
            Self::Here(control) => Some(work(control.as_mut())),
            Self::Elsewhere(jobs) => {
                let (sender, answer) = channel();
                let job = move |control: &mut dyn Control| {
                    let _ = sender.send(work(control));
                };
                jobs.send(Box::new(job)).ok()?;
                answer.recv().ok()
            }
        }
    }
}
