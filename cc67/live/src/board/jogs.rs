//! Axes that pages jog: each moves as long as a user holds its button, and stops when the page is silent.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use cc67_host::{Session, Target};
use kmotiondef::AxisId;

use super::ViewState;
use super::clock::now;
use crate::hub::PageId;

/// The longest time between two messages of a page while a button is held; it sends one every 0.1 s.
const SILENCE: Duration = Duration::from_millis(400);

/// A jog in progress.
#[derive(Clone, Copy, Debug)]
struct Jog {
    page: PageId,
    velocity: f64,
    /// The time of the page's last message.
    heard: Instant,
}

/// The jogs in progress.
#[derive(Debug, Default)]
pub(super) struct Jogs(BTreeMap<AxisId, Jog>);

impl Jogs {
    /// Forgets all jogs: the axes were stopped by other means.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}

impl<T: Target> ViewState<T> {
    /// Handles a button that is held or was released.
    pub(super) fn jog(
        &mut self,
        session: &mut Session<T>,
        page: PageId,
        axis: i32,
        velocity: f64,
    ) -> Result<(), String> {
        let axes = session.target().axes();
        let axis = axes.get(axis).ok_or_else(|| format!("no such axis {axis} (0-{})", axes.last()))?;
        if !velocity.is_finite() {
            return Err("the velocity is not a number".to_owned());
        }
        let before = self.access.jogs.0.get(&axis).copied();
        if before.is_some_and(|jog| jog.page != page) {
            return Err(format!("another page jogs axis {axis}"));
        }
        if velocity == 0.0 {
            return match self.access.jogs.0.remove(&axis) {
                Some(_) => self.command(session, &format!("Jog{axis}=0")),
                None => Ok(()),
            };
        }
        self.access.jogs.0.insert(axis, Jog { page, velocity, heard: now() });
        match before {
            Some(jog) if jog.velocity == velocity => Ok(()),
            Some(_) | None => self.command(session, &format!("Jog{axis}={velocity}")),
        }
    }

    /// Stops the axes whose pages are silent.
    pub(super) fn stop_silent_jogs(&mut self, session: &mut Session<T>) {
        self.stop_jogs(session, |jog| jog.heard.elapsed() > SILENCE);
    }

    /// Stops the axes of a disconnected page.
    pub(super) fn stop_jogs_of(&mut self, session: &mut Session<T>, page: PageId) {
        self.stop_jogs(session, |jog| jog.page == page);
    }

    fn stop_jogs(&mut self, session: &mut Session<T>, ends: impl Fn(&Jog) -> bool) {
        let ending: Vec<AxisId> =
            self.access.jogs.0.iter().filter(|(_, jog)| ends(jog)).map(|(axis, _)| *axis).collect();
        for axis in ending {
            self.access.jogs.0.remove(&axis);
            if let Err(problem) = self.command(session, &format!("Jog{axis}=0")) {
                self.log.add_message(session.tick(), super::EntrySource::Remark, problem);
            }
        }
    }
}
