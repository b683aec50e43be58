//! The memory of a process: a separate test binary, because it counts every allocation of its process.
//!
//! Its tests run one at a time, so that each counts only its own allocations.

mod host;
mod hostile;
mod leaks;

use std::sync::{Mutex, MutexGuard, PoisonError};

use peak_alloc::PeakAlloc;

/// The counter of all allocations in this process.
#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

static ALONE: Mutex<()> = Mutex::new(());

/// Waits until no other test runs, and blocks the others until the guard is dropped.
fn alone() -> MutexGuard<'static, ()> {
    // A failed test leaves nothing that the next one uses.
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}
