//! The hostile inputs: each has a name, a text, and the expected message if it is certain.

mod nested;
mod repeated;
mod truncated;

/// A hostile source file.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    /// The property that it tests.
    pub(crate) name: String,
    /// The text.
    pub(crate) text: Vec<u8>,
    /// Part of the expected error message: the limit that is exceeded, with its number.
    pub(crate) says: Option<&'static str>,
}

impl Input {
    /// An input for which any answer is accepted.
    pub(crate) fn new(name: impl Into<String>, text: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), text: text.into(), says: None }
    }

    /// Adds an expected message to the input.
    #[must_use]
    pub(crate) fn says(mut self, part: &'static str) -> Self {
        self.says = Some(part);
        self
    }
}

/// All inputs that are compiled in the process of the test.
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
