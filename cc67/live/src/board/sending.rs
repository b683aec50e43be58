//! Messages and frames for pages.

use std::collections::VecDeque;
use std::sync::Arc;

use cc67_host::{Session, Target};
use serde_json::{Value, json};

use super::clock::now;
use super::frame::{self, FrameClock};
use super::{BEAT, THREADS, ViewState, box_message, log_message, threads};
use crate::hub::PageId;

impl<T: Target> ViewState<T> {
    /// Sends new information to pages.
    pub(super) fn send_updates(&mut self, session: &Session<T>) {
        self.tell_link(session);
        let fresh = self.log.take_fresh();
        let entries = (!fresh.is_empty()).then(|| log_message(&fresh));
        if let Some(entries) = entries {
            self.broadcast(&entries);
        }
        if !self.pages.is_empty() && self.told.at.elapsed() >= THREADS {
            let rows = threads::rows(session);
            if rows != self.told.threads || self.clock.is_running() {
                // Slightly older slices are good enough while the board runs.
                let turns = self.turns.until(session.tick());
                let none = VecDeque::new();
                let turns = if self.clock.is_running() { turns } else { Some(turns.unwrap_or(&none)) };
                let tick = session.tick().get();
                self.broadcast(&json!({ "kind": "threads", "threads": rows, "tick": tick, "turns": turns }));
            }
            (self.told.threads, self.told.at) = (rows, now());
            let open_box = session.target().open_box();
            if open_box != self.told.open_box {
                self.broadcast(&box_message(open_box.as_ref()));
                self.told.open_box = open_box;
            }
        }
        self.send_frames(session);
    }

    /// Sends a frame to each page for which one is due and that has taken the last one.
    pub(super) fn send_frames(&mut self, session: &Session<T>) {
        let tick = session.tick();
        let moment = FrameClock {
            is_running: self.clock.is_running(),
            is_past: self.is_past(session),
            end: self.end(session),
            speed: [self.clock.speed(), self.clock.measured(tick)],
        };
        for page in self.pages.values_mut() {
            let Some(every) = page.every else { continue };
            let since = page.last.elapsed();
            if since + BEAT / 2 < every || !page.mailbox.wants_frame() {
                continue;
            }
            if page.generation != self.samples.generation {
                (page.generation, page.next_row) = (self.samples.generation, 0);
            }
            let (bytes, next) = frame::frame(session, moment, &self.samples, page.next_row);
            page.next_row = next;
            // A frame that is one beat late does not delay the following ones, so that the requested rate is kept.
            page.last = if since < 2 * every { page.last + every } else { now() };
            page.mailbox.show(bytes);
        }
    }

    /// Informs pages that the board is no longer shown.
    pub(super) fn close(&self) {
        self.pages.values().for_each(|page| page.mailbox.close());
    }

    pub(super) fn answer(&self, id: PageId, message: &Value) {
        if let Some(page) = self.pages.get(&id) {
            page.mailbox.post(&message.to_string().into());
        }
    }

    pub(super) fn broadcast(&self, message: &Value) {
        let text: Arc<str> = message.to_string().into();
        self.pages.values().for_each(|page| page.mailbox.post(&text));
    }
}
