//! Message and input boxes that stay open until a person answers them.

/// A box that a program has opened on the PC and that has not been answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OpenBox {
    /// A message; the answer is `msgbox=` and a button.
    Message {
        /// The text of the box.
        text: String,
        /// Its buttons from left to right.
        buttons: &'static [&'static str],
    },
    /// A prompt for a number; the answer is `input=` and the number, or `cancel`.
    Input {
        /// The text of the box.
        text: String,
    },
}

impl OpenBox {
    /// A message box with these flags, the low four bits of which choose the buttons. Source: gather-persist-console.md
    /// section 8.
    pub(super) fn message(text: String, flags: i32) -> Self {
        let buttons: &[_] = match flags & 0xf {
            1 => &["ok", "cancel"],
            2 => &["abort", "retry", "ignore"],
            3 => &["yes", "no", "cancel"],
            4 => &["yes", "no"],
            5 => &["retry", "cancel"],
            _ => &["ok"],
        };
        Self::Message { text, buttons }
    }

    /// Returns whether it has more than one button.
    pub(super) const fn has_choice(&self) -> bool {
        match self {
            Self::Message { buttons, .. } => buttons.len() > 1,
            Self::Input { .. } => true,
        }
    }

    /// Returns the line that is shown when it opens.
    pub(super) fn shown(&self) -> String {
        match self {
            Self::Message { text, .. } => format!("message box: {text}: waiting for an answer"),
            Self::Input { text } => format!("input box: {text}: waiting for an answer"),
        }
    }
}
