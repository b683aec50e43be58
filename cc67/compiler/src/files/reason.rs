//! The operating system's reasons for a failure, in words for the user.

use std::io;

/// The reason alone: the number that the library adds means nothing to the user.
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or_default().to_owned()
}
