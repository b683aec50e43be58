//! The exceptions of the package, which are written in Python, and the mapping of errors to them.

use std::fmt::Display;
use std::io;
use std::path::Path;

use pyo3::PyErr;
use pyo3::exceptions::PyOSError;

pyo3::import_exception!(cc67._errors, Error);
pyo3::import_exception!(cc67._errors, InputError);
pyo3::import_exception!(cc67._errors, LinkError);
pyo3::import_exception!(cc67._errors, LoadError);
pyo3::import_exception!(cc67._errors, RangeError);
pyo3::import_exception!(cc67._errors, ThreadError);
pyo3::import_exception!(cc67._errors, TrapError);
pyo3::import_exception!(cc67._errors, ExpectationError);

/// An input is wrong: a file, an option, an expression, a number.
pub(crate) fn input(error: impl Display) -> PyErr {
    InputError::new_err(error.to_string())
}

/// A file that cannot be read is the exception that Python has for it, such as `FileNotFoundError`.
pub(crate) fn unreadable(path: &Path, error: &io::Error) -> PyErr {
    let text = error.to_string();
    let Some(number) = error.raw_os_error() else {
        return PyOSError::new_err(format!("{}: {text}", path.display()));
    };
    let text = text.strip_suffix(&format!(" (os error {number})")).unwrap_or(&text).to_owned();
    // Windows takes the last argument for its own number of the error; other systems ignore it.
    PyOSError::new_err((number, text, path.as_os_str().to_owned(), number))
}
