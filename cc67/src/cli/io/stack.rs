//! The stack of the command: that of the process, or a separate one if the operating system provides little (`ulimit
//! -s`).

use std::io;
use std::panic::resume_unwind;
use std::thread;

/// The stack that the command may need, in bytes.
pub(in crate::cli) const NEEDED: usize = 8 << 20;

/// Reports whether the stack of the process is smaller than the command needs; without this information, it is assumed
/// to be large enough.
pub(in crate::cli) fn is_small() -> bool {
    let limits = std::fs::read_to_string("/proc/self/limits").unwrap_or_default();
    limits_stack(&limits).is_some_and(|bytes| bytes < NEEDED)
}

/// The limit of the stack in a list of limits; `None` if there is none.
fn limits_stack(limits: &str) -> Option<usize> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max stack size"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Runs on a sufficiently large stack.
///
/// # Errors
/// The operating system cannot start such a thread.
pub(in crate::cli) fn on_own<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> io::Result<T> {
    let handle = thread::Builder::new().name("main".to_owned()).stack_size(NEEDED).spawn(work)?;
    Ok(handle.join().unwrap_or_else(|panic| resume_unwind(panic)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_of_the_stack_is_read() {
        let list = "Limit                     Soft Limit           Hard Limit           Units     \n\
                    Max data size             unlimited            unlimited            bytes     \n\
                    Max stack size            262144               unlimited            bytes     \n";
        assert_eq!(limits_stack(list), Some(262_144));
        assert_eq!(limits_stack(&list.replace("262144", "unlimited")), None);
        assert_eq!(limits_stack(""), None);
    }
}
