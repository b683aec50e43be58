//! The operating system's reasons for a failure, in words for the user.

use std::io;

/// The text of the error without the number added by the library, which means nothing to the user.
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or_default().to_owned()
}
