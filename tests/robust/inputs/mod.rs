//! The hostile inputs: each a name, a text, and what must be said of it if that is certain.

mod nested;
mod repeated;
mod truncated;

/// A source file that means no good.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    /// The property that it tries.
    pub(crate) name: String,
    /// The text.
    pub(crate) text: Vec<u8>,
    /// Part of an error message: the limit that it must hit, with its number.
    pub(crate) says: Option<&'static str>,
}

impl Input {
    /// An input of which nothing is demanded but an answer.
    pub(crate) fn new(name: impl Into<String>, text: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), text: text.into(), says: None }
    }

    /// The input, with a message that must come.
    #[must_use]
    pub(crate) fn says(mut self, part: &'static str) -> Self {
        self.says = Some(part);
        self
    }
}

/// Every input that is compiled in the process of the test.
pub(crate) fn all() -> Vec<Input> {
    [nested::inputs(), repeated::inputs(), truncated::inputs()].concat()
}

/// The inputs that could take much memory.
pub(crate) fn heavy() -> Vec<Input> {
    repeated::heavy()
}

/// The body of `main`.
fn in_main(body: impl AsRef<str>) -> String {
    format!("#include \"KMotionDef.h\"\nint a, b, *p;\nmain()\n{{\n{}\n}}\n", body.as_ref())
}
