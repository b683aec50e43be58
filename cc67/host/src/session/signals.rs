//! Signals: values that are sampled at a rate.
//!
//! A subscription is sampled after every tick that is a multiple of its interval, even if its values have not changed.
//! Sampling changes nothing on the board.

use std::fmt;

use crate::target::Target;
use kmotiondef::Ticks;

use super::{Session, Watch};
use crate::HostError;

/// Names a subscription of a session.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SubscriptionId(u64);

/// The receiver of samples: the tick, and the values in the order of the subscription.
type Receiver = Box<dyn FnMut(Ticks, &[f64]) + Send>;

struct Subscription {
    id: SubscriptionId,
    watched: Vec<Watch>,
    every: u64,
    receiver: Receiver,
}

/// The subscriptions of a session.
#[derive(Default)]
pub(super) struct Signals {
    subscriptions: Vec<Subscription>,
    /// The number of subscriptions created so far.
    count: u64,
    /// The tick up to which samples have been taken.
    last: Ticks,
    /// The subscription that the target itself samples.
    on_target: Option<SubscriptionId>,
}

impl fmt::Debug for Signals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Signals").field("count", &self.subscriptions.len()).finish_non_exhaustive()
    }
}

impl Signals {
    /// Returns the tick up to which the board may run before something is sampled.
    pub(super) fn next_sample(&self, tick: Ticks, limit: Ticks) -> Ticks {
        let next = |subscription: &Subscription| (tick.get() / subscription.every + 1) * subscription.every;
        let next = self.subscriptions.iter().map(next).min();
        next.map_or(limit, |next| Ticks::new(next).min(limit))
    }

    /// Notes that the board is at another tick without having run: samples due there are taken when it continues.
    pub(super) const fn went_to(&mut self, tick: Ticks) {
        self.last = tick;
    }
}

impl<T: Target> Session<T> {
    /// Passes the values of expressions to a receiver every `every` ticks, beginning with the next multiple; the
    /// receiver is called during any call that lets time pass.
    ///
    /// ```
    /// use std::sync::mpsc;
    ///
    /// use cc67_host::Setup;
    ///
    /// let mut session = Setup::default().session()?;
    /// session.act(r#"command "EnableAxis0;Jog0=1000""#)?;
    /// let (sender, samples) = mpsc::channel();
    /// let dest = session.watch("chan[0].Dest")?;
    /// session.subscribe(vec![dest], 100, move |tick, values| sender.send((tick.get(), values[0])).expect("it is awaited"));
    /// session.advance(session.tick_after(0.05), &mut |_| ());
    /// let samples: Vec<_> = samples.try_iter().collect();
    /// assert_eq!(samples.iter().map(|(tick, _)| *tick).collect::<Vec<_>>(), [100, 200, 300, 400, 500]);
    /// assert!(samples.is_sorted_by(|(_, a), (_, b)| a < b));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn subscribe(
        &mut self,
        watched: Vec<Watch>,
        every: u64,
        receiver: impl FnMut(Ticks, &[f64]) + Send + 'static,
    ) -> SubscriptionId {
        self.signals.count += 1;
        let id = SubscriptionId(self.signals.count);
        self.signals.last = self.tick();
        let receiver = Box::new(receiver);
        self.signals.subscriptions.push(Subscription { id, watched, every: every.max(1), receiver });
        id
    }

    /// Makes the target itself sample a subscription, faster than values can be read
    /// ([`Capability::FastSamples`](crate::Capability::FastSamples)); returns the number of samples per second. Values
    /// that the target cannot sample are taken from its last status record.
    ///
    /// # Errors
    /// The target cannot sample, or cannot sample these values now.
    pub fn sample_on_target(&mut self, id: SubscriptionId) -> Result<f64, HostError> {
        let subscription = self.signals.subscriptions.iter().find(|subscription| subscription.id == id);
        let watched = subscription.map(|subscription| subscription.watched.clone()).unwrap_or_default();
        self.signals.on_target = None;
        let rate = self.target.sample(watched.into_iter().map(Watch::into_quantity).collect())?;
        self.signals.on_target = Some(id);
        Ok(rate)
    }

    /// Ends the sampling begun by [`sample_on_target`](Self::sample_on_target): the session reads the values again.
    pub fn end_sampling_on_target(&mut self) {
        if self.signals.on_target.take().is_some() {
            // A target that is lost needs no end of sampling.
            let _ = self.target.sample(Vec::new());
        }
    }

    /// Ends a subscription.
    pub fn unsubscribe(&mut self, id: SubscriptionId) {
        if self.signals.on_target == Some(id) {
            self.end_sampling_on_target();
        }
        self.signals.subscriptions.retain(|subscription| subscription.id != id);
    }

    /// Passes on the samples due at the present tick.
    pub(super) fn sample(&mut self) {
        let tick = self.tick();
        if self.signals.subscriptions.is_empty() || self.signals.last == tick {
            return;
        }
        let on_target = self.take_from_target();
        let last = std::mem::replace(&mut self.signals.last, tick);
        for subscription in &mut self.signals.subscriptions {
            if on_target == Some(subscription.id) {
                continue;
            }
            // A simulated board stops at each multiple; the time of a connected one may have passed it.
            if last.get() / subscription.every < tick.get() / subscription.every {
                let values: Vec<f64> =
                    subscription.watched.iter().map(|watch| watch.value(&self.target)).collect();
                (subscription.receiver)(tick, &values);
            }
        }
    }

    /// Passes on the samples that the target has taken; returns the subscription, or `None` once sampling has ended.
    fn take_from_target(&mut self) -> Option<SubscriptionId> {
        let id = self.signals.on_target?;
        let Some(rows) = self.target.take_samples() else {
            self.signals.on_target = None;
            return None;
        };
        let subscription =
            self.signals.subscriptions.iter_mut().find(|subscription| subscription.id == id)?;
        for (tick, mut values) in rows {
            for (value, watch) in values.iter_mut().zip(&subscription.watched) {
                if value.is_nan() {
                    *value = watch.value(&self.target);
                }
            }
            (subscription.receiver)(tick, &values);
        }
        Some(id)
    }
}
