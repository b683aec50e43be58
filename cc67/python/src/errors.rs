//! The exceptions of the package, which are written in Python, and the mapping of errors to them.

use std::fmt::Display;

use pyo3::PyErr;

pyo3::import_exception!(cc67._errors, Error);
pyo3::import_exception!(cc67._errors, InputError);
pyo3::import_exception!(cc67._errors, LoadError);
pyo3::import_exception!(cc67._errors, ThreadError);
pyo3::import_exception!(cc67._errors, TrapError);
pyo3::import_exception!(cc67._errors, ExpectationError);

/// An input is wrong: a file, an option, an expression, a number.
pub(crate) fn input(error: impl Display) -> PyErr {
    InputError::new_err(error.to_string())
}

/// A file that cannot be read is the exception that Python has for it.
pub(crate) fn unreadable(path: &std::path::Path, error: &std::io::Error) -> PyErr {
    match error.raw_os_error() {
        Some(number) => {
            let arguments = (number, error.to_string(), path.to_path_buf());
            pyo3::exceptions::PyOSError::new_err(arguments)
        }
        None => pyo3::exceptions::PyOSError::new_err(format!("{}: {error}", path.display())),
    }
}
