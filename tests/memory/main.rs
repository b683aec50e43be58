//! Memory of a process: a test binary of its own, because it counts every allocation of its process.
//!
//! Its tests run one at a time, so that each counts only its own.

mod host;
mod hostile;
mod leaks;

use std::sync::{Mutex, MutexGuard, PoisonError};

use peak_alloc::PeakAlloc;

/// Every allocation of this process.
#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

static ALONE: Mutex<()> = Mutex::new(());

/// Waits until no other test runs, and holds the others off until the guard is dropped.
fn alone() -> MutexGuard<'static, ()> {
    // A test that failed has left nothing that the next one reads.
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}
