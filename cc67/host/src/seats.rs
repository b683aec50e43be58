//! Seats of a server: a limited number of connections, in which a new connection always gets a place.
//!
//! An idle connection occupies a seat. When all are taken, the connection that has been silent the longest is closed
//! for the new one: first one that has never sent anything, then the one whose last data are the oldest. So idle
//! clients, however many, cannot keep a new one out. The order is the order of events, not of a clock. A connection
//! that cannot be closed from outside keeps its seat.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// The time that a server waits for a client's first data.
pub const FIRST_WORDS: Duration = Duration::from_secs(10);

/// Closes a connection, so that its reader reaches the end.
pub type Closer = Box<dyn FnOnce() + Send>;

/// The limited connection slots of a server.
#[derive(Clone, Debug)]
pub struct Seats {
    most: usize,
    taken: Arc<Mutex<SeatTable>>,
}

#[derive(Debug, Default)]
struct SeatTable {
    /// The number of events so far.
    events: u64,
    seats: Vec<TakenSeat>,
}

struct TakenSeat {
    number: u64,
    has_spoken: bool,
    /// The number of its last event.
    last: u64,
    close: Option<Closer>,
}

impl fmt::Debug for TakenSeat {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("TakenSeat").field("number", &self.number).finish_non_exhaustive()
    }
}

/// A seat, which becomes free when this is dropped.
#[derive(Debug)]
pub struct Seat {
    seats: Seats,
    number: u64,
}

/// The seat of a new connection.
#[derive(Debug)]
pub struct Admission {
    /// The seat of the connection.
    pub seat: Seat,
    /// True if another connection was closed for this one.
    pub has_closed_another: bool,
}

impl Seats {
    /// A server with `most` seats.
    #[must_use]
    pub fn new(most: usize) -> Self {
        Self { most, taken: Arc::default() }
    }

    fn taken(&self) -> MutexGuard<'_, SeatTable> {
        // The list is consistent at all times.
        self.taken.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes a seat for a new connection; `None` if all are taken by connections that cannot be closed.
    #[must_use]
    pub fn take(&self, close: Option<Closer>) -> Option<Admission> {
        let mut taken = self.taken();
        taken.events += 1;
        let number = taken.events;
        let mut closer = None;
        if taken.seats.len() >= self.most {
            let seats = taken.seats.iter().enumerate().filter(|(_, seat)| seat.close.is_some());
            let (oldest, _) = seats.min_by_key(|(_, seat)| (seat.has_spoken, seat.last))?;
            closer = taken.seats.remove(oldest).close;
        }
        taken.seats.push(TakenSeat { number, has_spoken: false, last: number, close });
        drop(taken);
        let has_closed_another = closer.is_some();
        if let Some(close) = closer {
            close();
        }
        Some(Admission { seat: Seat { seats: self.clone(), number }, has_closed_another })
    }
}

impl Seat {
    /// Notes that the client has sent data.
    pub fn mark_active(&self) {
        let mut taken = self.seats.taken();
        taken.events += 1;
        let last = taken.events;
        if let Some(seat) = taken.seats.iter_mut().find(|seat| seat.number == self.number) {
            seat.has_spoken = true;
            seat.last = last;
        }
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.seats.taken().seats.retain(|seat| seat.number != self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_silent_connection_gives_its_seat_to_a_new_one() {
        let closed = Arc::new(Mutex::new(Vec::new()));
        let seats = Seats::new(3);
        let take = |name: &'static str| {
            let closed = Arc::clone(&closed);
            let close: Closer = Box::new(move || closed.lock().expect("no thread panics").push(name));
            seats.take(Some(close)).expect("there is a seat")
        };
        let names = || closed.lock().expect("no thread panics").clone();
        let first = take("first").seat;
        first.mark_active();
        let _second = take("second");
        let third = take("third");
        assert!(!third.has_closed_another && names().is_empty());
        // Silent connections are closed first, in the order in which they came.
        let fourth = take("fourth");
        assert!(fourth.has_closed_another);
        assert_eq!(names(), ["second"]);
        third.seat.mark_active();
        fourth.seat.mark_active();
        first.mark_active();
        // Of the others, the one whose last data are the oldest.
        let fifth = take("fifth");
        assert_eq!(names(), ["second", "third"]);
        drop(fifth);
        assert!(!take("sixth").has_closed_another);
    }

    #[test]
    fn connections_that_cannot_be_closed_keep_their_seats() {
        let seats = Seats::new(1);
        let only = seats.take(None);
        assert!(only.is_some() && seats.take(None).is_none());
        drop(only);
        assert!(seats.take(None).is_some());
    }
}
