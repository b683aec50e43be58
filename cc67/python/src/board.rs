//! A board for Python: its owning thread, signals while it runs, exceptions.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{LazyLock, Mutex, PoisonError, TryLockError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

use cc67_host::{Session, Target, Until};
use kmotiondef::Bit;
use kmotiondef::limits::TIMEBASE;
use numpy::PyArray1;
use pyo3::prelude::*;
use vm::interp::BytecodeEngine;
use vm::native::{NativeEngine, SharedCode};

use crate::control::{AxisField, Control, Fault, LogLine, LoggedSession, PortionResult, StoreError, fields};
use crate::controller::{Controller, ControllerTerms};
use crate::errors::{Error, ExpectationError, LinkError, RangeError, ThreadError, TrapError, input};
use crate::program::{LinkableProgram, thread};
use crate::setup::{BoardArguments, refused};
use crate::trace::MOST_VALUES;

/// Numbers for boards and snapshots, so that one board's snapshot is not taken for another's.
static NUMBERS: AtomicU64 = AtomicU64::new(1);

/// The native code of all boards, shared: a sweep makes a thousand boards of one program.
static COMPILED: LazyLock<SharedCode> = LazyLock::new(SharedCode::default);

/// The time that a run continues before Python's signals are checked.
const LOOK: Duration = Duration::from_millis(20);

/// A column of a trace.
type Column<'py> = Bound<'py, PyArray1<f64>>;

/// A board, and the thread that uses it.
struct OwnedControl {
    /// The board; `None` after it is closed.
    control: Option<Box<dyn Control + Send>>,
    owner: Option<ThreadId>,
}

/// A simulated board.
#[pyclass(frozen)]
pub(crate) struct Board {
    used: Mutex<OwnedControl>,
    /// Name and unit of each axis.
    #[pyo3(get)]
    axes: Vec<(String, String)>,
    /// Number of the board, different for each.
    #[pyo3(get)]
    number: u64,
}

/// The condition that a run waits for, as Python states it.
#[derive(Debug, FromPyObject)]
enum Awaited {
    /// An expression is not 0.
    #[pyo3(transparent)]
    True(String),
    /// `("printed", text)`, `("ended", thread)` or `("active", thread)`.
    #[pyo3(transparent)]
    Other((String, String)),
}

impl Board {
    /// Calls the session from the thread that uses the board, with the interpreter's lock released.
    fn call<R: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut dyn Control) -> R + Send + 'static,
    ) -> PyResult<R> {
        let mut used = match self.used.try_lock() {
            Ok(used) => used,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => {
                return Err(ThreadError::new_err(
                    "the board is running in another thread; a board is for one thread",
                ));
            }
        };
        let caller = thread::current().id();
        if *used.owner.get_or_insert(caller) != caller {
            return Err(ThreadError::new_err(
                "the board belongs to the thread that used it first; that thread can give it up with `release()`",
            ));
        }
        let control = used.control.as_mut().ok_or_else(|| Error::new_err("the board is closed"))?;
        Ok(py.detach(move || work(control.as_mut())))
    }

    /// A run in portions, with a look at signals every [`LOOK`]; whether what it waited for came true.
    ///
    /// The moments of these looks change nothing that a program can see.
    fn run_in_portions(
        &self,
        py: Python<'_>,
        portion: impl Fn(&mut dyn Control) -> PortionResult + Clone + Send + 'static,
    ) -> PyResult<bool> {
        loop {
            let portion = portion.clone();
            let PortionResult { is_over, is_met, fault } = self.call(py, move |control| {
                let begin = Instant::now();
                loop {
                    let done = portion(control);
                    if done.is_over || done.fault.is_some() || begin.elapsed() >= LOOK {
                        return done;
                    }
                }
            })?;
            if let Some(fault) = fault {
                return Err(exception(fault));
            }
            if is_over {
                return Ok(is_met);
            }
            py.check_signals()?;
        }
    }
}

/// Converts a fault of a run into an exception.
fn exception(fault: Fault) -> PyErr {
    match fault {
        Fault::Unmet { text } => ExpectationError::new_err(text),
        Fault::Trap { text, time, thread, place } => TrapError::new_err((text, time, thread, place)),
        Fault::Lost { text } => LinkError::new_err(text),
    }
}

/// A session as a board has it.
fn boxed<T: Target + Send + 'static>(session: Session<T>) -> Box<dyn Control + Send>
where
    T::Snapshot: Send,
{
    Box::new(LoggedSession::new(session))
}

/// Converts the reason why a value is not stored into an exception.
fn unwritten(reason: StoreError) -> PyErr {
    match reason {
        StoreError::Wrong(error) => input(error),
        StoreError::TooLarge(text) => RangeError::new_err(text),
        StoreError::Refused(text) => Error::new_err(text),
    }
}

fn lines(lines: &[LogLine]) -> Vec<(f64, String)> {
    lines.iter().map(|line| (line.time, line.text.clone())).collect()
}

fn bit(number: i32) -> PyResult<Bit> {
    Bit::new(number).ok_or_else(|| {
        pyo3::exceptions::PyIndexError::new_err(format!("no such bit {number} (0-{})", Bit::MAX))
    })
}

#[pymethods]
impl Board {
    #[new]
    fn new(py: Python<'_>, request: BoardArguments<'_>, engine: &str) -> PyResult<Self> {
        let arranged = request.arrange()?;
        let setup = arranged.setup;
        let control = match (engine, arranged.firmware) {
            (_, Some(firmware)) => py.detach(|| setup.session_on_firmware(&firmware).map(boxed)),
            ("bytecode", None) => py.detach(|| setup.session_on(BytecodeEngine::default()).map(boxed)),
            ("native", None) => {
                py.detach(|| setup.session_on(NativeEngine::with_shared(COMPILED.clone())).map(boxed))
            }
            _ => return Err(input(format!("engine must be \"native\" or \"bytecode\", not {engine:?}"))),
        };
        let used = Mutex::new(OwnedControl { control: Some(control.map_err(refused)?), owner: None });
        Ok(Self { used, axes: arranged.axes, number: NUMBERS.fetch_add(1, Ordering::Relaxed) })
    }

    /// Make a board of a controller, and load and start its programs.
    #[staticmethod]
    fn on(
        py: Python<'_>,
        controller: &Controller,
        request: BoardArguments<'_>,
        terms: ControllerTerms,
    ) -> PyResult<Self> {
        let arranged = request.arrange()?;
        let (link, mut setup) = (controller.take()?, arranged.setup);
        setup.options = link.options();
        let control = py.detach(|| link.session(setup, terms.into(), |_, _| ()).map(boxed));
        let used = Mutex::new(OwnedControl { control: Some(control.map_err(refused)?), owner: None });
        Ok(Self { used, axes: arranged.axes, number: NUMBERS.fetch_add(1, Ordering::Relaxed) })
    }

    /// Give up the board; it then belongs to the thread that uses it next.
    fn release(&self, py: Python<'_>) -> PyResult<()> {
        self.call(py, |_| ())?;
        self.used.lock().unwrap_or_else(PoisonError::into_inner).owner = None;
        Ok(())
    }

    /// Free the memory of the board; whatever uses it afterwards raises `Error`.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        let Ok(mut used) = self.used.try_lock() else {
            return Err(ThreadError::new_err(
                "the board is running in another thread, which has to end first",
            ));
        };
        let control = used.control.take();
        py.detach(|| drop(control));
        Ok(())
    }

    #[getter]
    fn is_closed(&self) -> bool {
        // What runs is not closed.
        self.used.try_lock().is_ok_and(|used| used.control.is_none())
    }

    fn tick(&self, py: Python<'_>) -> PyResult<u64> {
        self.call(py, |control| control.tick())
    }

    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.tick(py)? as f64 * TIMEBASE)
    }

    /// Return the tick some seconds from now.
    fn after(&self, py: Python<'_>, seconds: f64) -> PyResult<u64> {
        if !(0.0..=1e12).contains(&seconds) {
            return Err(input(format!("a time must be 0 to 1e12 seconds, not {seconds}")));
        }
        let ticks = (seconds / TIMEBASE).round() as u64;
        Ok(self.tick(py)?.saturating_add(ticks))
    }

    fn run_for(&self, py: Python<'_>, seconds: f64) -> PyResult<()> {
        let limit = self.after(py, seconds)?;
        self.run_in_portions(py, move |control| control.advance(limit)).map(|_| ())
    }

    fn step(&self, py: Python<'_>, ticks: u64) -> PyResult<()> {
        let limit = self.tick(py)?.saturating_add(ticks);
        self.run_in_portions(py, move |control| control.advance(limit)).map(|_| ())
    }

    fn step_thread(&self, py: Python<'_>, number: i32, timeout: f64) -> PyResult<bool> {
        let (thread, limit) = (thread(number)?, self.after(py, timeout)?);
        self.run_in_portions(py, move |control| control.step_thread(thread, limit))
    }

    fn run(&self, py: Python<'_>, timeout: f64) -> PyResult<bool> {
        let limit = self.after(py, timeout)?;
        let has_ended = self.run_in_portions(py, move |control| control.run(limit))?;
        self.run_in_portions(py, |control| control.finish())?;
        Ok(has_ended)
    }

    fn finish(&self, py: Python<'_>) -> PyResult<()> {
        self.run_in_portions(py, |control| control.finish()).map(|_| ())
    }

    fn run_until(&self, py: Python<'_>, condition: Awaited, timeout: f64) -> PyResult<bool> {
        let limit = self.after(py, timeout)?;
        let until = match condition {
            Awaited::True(text) => {
                Until::True(self.call(py, move |control| control.watch(&text))?.map_err(input)?)
            }
            Awaited::Other((kind, text)) if kind == "printed" => Until::Printed(text),
            Awaited::Other((kind, number)) => {
                let number = number.parse().map_err(|_| input(format!("`{number}` is not a thread")))?;
                Until::Active(thread(number)?, kind == "active")
            }
        };
        self.run_in_portions(py, move |control| control.run_until(&until, limit))
    }

    fn has_ended(&self, py: Python<'_>) -> PyResult<bool> {
        self.call(py, |control| control.has_ended())
    }

    fn is_active(&self, py: Python<'_>, number: i32) -> PyResult<bool> {
        let thread = thread(number)?;
        self.call(py, move |control| control.is_active(thread))
    }

    fn load(&self, py: Python<'_>, number: i32, program: &LinkableProgram, starts: bool) -> PyResult<()> {
        let program = program.for_thread(thread(number)?)?;
        let program = if starts { program.started() } else { program };
        self.call(py, move |control| control.load(program))?.map_err(refused)
    }

    fn start(&self, py: Python<'_>, number: i32) -> PyResult<()> {
        let thread = thread(number)?;
        self.call(py, move |control| control.start(thread))?.map_err(refused)
    }

    fn stop(&self, py: Python<'_>, number: i32) -> PyResult<()> {
        let thread = thread(number)?;
        self.call(py, move |control| control.stop(thread))
    }

    fn command(&self, py: Python<'_>, line: Vec<u8>) -> PyResult<Vec<String>> {
        let (reply, fault) = self.call(py, move |control| control.exchange(&line))?;
        fault.map_or(Ok(reply), |fault| Err(exception(fault)))
    }

    fn act(&self, py: Python<'_>, action: String) -> PyResult<()> {
        self.call(py, move |control| control.act(&action))?.map_err(input)
    }

    fn send_to_uart(&self, py: Python<'_>, bytes: Vec<u8>) -> PyResult<()> {
        self.call(py, move |control| control.send_to_uart(&bytes))
    }

    fn uart(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
        self.call(py, |control| control.log().uart.clone())
    }

    fn console(&self, py: Python<'_>, first: usize) -> PyResult<Vec<(f64, String)>> {
        self.call(py, move |control| lines(control.log().console.get(first..).unwrap_or_default()))
    }

    fn remarks(&self, py: Python<'_>) -> PyResult<Vec<(f64, String)>> {
        self.call(py, |control| lines(&control.log().remarks))
    }

    fn faults(&self, py: Python<'_>) -> PyResult<Vec<Py<PyAny>>> {
        let faults = self.call(py, |control| control.log().faults.clone())?;
        Ok(faults.into_iter().map(|fault| exception(fault).into_value(py).into_any()).collect())
    }

    fn stop_at_faults(&self, py: Python<'_>, stops: bool) -> PyResult<()> {
        self.call(py, move |control| control.stop_at_faults(stops))
    }

    fn recording(&self, py: Python<'_>) -> PyResult<(String, bool)> {
        self.call(py, |control| control.recording())
    }

    fn bit(&self, py: Python<'_>, number: i32) -> PyResult<bool> {
        let bit = bit(number)?;
        let level = self.call(py, move |control| control.bit(bit))?;
        level.map_err(|error| Error::new_err(error.to_string()))
    }

    fn drive(&self, py: Python<'_>, number: i32, level: bool) -> PyResult<()> {
        let bit = bit(number)?;
        self.call(py, move |control| control.drive(bit, level))?.map_err(input)
    }

    fn read(&self, py: Python<'_>, expression: String) -> PyResult<f64> {
        let (value, is_connected) = self.call(py, {
            let expression = expression.clone();
            move |control| (control.read(&expression), control.is_connected())
        })?;
        let value = value.map_err(input)?;
        if is_connected && value.is_nan() {
            return Err(Error::new_err(format!(
                "{expression:?} cannot be read: no command of a controller reads memory besides persist.UserData and what \
                 its status record has; a board of `connect(…, monitor=True)` does"
            )));
        }
        Ok(value)
    }

    fn write(&self, py: Python<'_>, expression: String, value: f64) -> PyResult<()> {
        self.call(py, move |control| control.write(&expression, value))?.map_err(unwritten)
    }

    fn field(&self, py: Python<'_>, axis: usize, name: String) -> PyResult<Option<f64>> {
        let field = self.call(py, move |control| control.field(axis, &name))?;
        field.map_err(|error| Error::new_err(error.to_string()))
    }

    fn set_field(&self, py: Python<'_>, axis: usize, name: String, value: f64) -> PyResult<bool> {
        self.call(py, move |control| control.set_field(axis, &name, value))?.map_err(unwritten)
    }

    /// Return the name of each numeric field of an axis, its meaning, and whether it is an integer.
    #[staticmethod]
    fn field_names() -> Vec<(&'static str, &'static str, bool)> {
        fields().map(|AxisField { name, doc, is_integer }| (name, doc, is_integer)).collect()
    }

    fn user_data(&self, py: Python<'_>, index: usize) -> PyResult<Option<i32>> {
        self.call(py, move |control| control.user_data(index))
    }

    fn set_user_data(&self, py: Python<'_>, index: usize, value: i32) -> PyResult<bool> {
        self.call(py, move |control| control.set_user_data(index, value))
    }

    /// Save the present state, and return its number.
    fn snapshot(&self, py: Python<'_>) -> PyResult<u64> {
        let number = NUMBERS.fetch_add(1, Ordering::Relaxed);
        self.call(py, move |control| control.snapshot(number))?.map_err(input)?;
        Ok(number)
    }

    fn restore(&self, py: Python<'_>, number: u64) -> PyResult<bool> {
        self.call(py, move |control| control.restore(number))
    }

    /// Forget a saved state, from any thread; a board that is running at that moment keeps it.
    fn forget(&self, number: u64) {
        if let Ok(mut used) = self.used.try_lock() {
            // A board that is closed has nothing to forget.
            if let Some(control) = &mut used.control {
                control.forget(number);
            }
        }
    }

    /// Record samples, and return their times, and names with values, as arrays that own their memory.
    fn trace<'py>(
        &self,
        py: Python<'py>,
        items: Vec<String>,
        seconds: f64,
        every: u64,
    ) -> PyResult<(Column<'py>, Vec<(String, Column<'py>)>)> {
        let samples = (self.after(py, seconds)?.saturating_sub(self.tick(py)?) / every.max(1)) as usize;
        if samples.saturating_mul(items.len() + 1) > MOST_VALUES {
            let values = samples.saturating_mul(items.len() + 1);
            return Err(input(format!("a trace of {values} values is too long; the limit is {MOST_VALUES}")));
        }
        self.call(py, move |control| control.begin_trace(&items, every.max(1), samples))?.map_err(input)?;
        let result = self.run_in_portions(py, |control| control.trace());
        let columns = self.call(py, |control| control.end_trace())?;
        result?;
        let columns = columns.ok_or_else(|| Error::new_err("the trace is gone, which is a bug in cc67"))?;
        let arrays = columns.named.into_iter().map(|(name, column)| (name, PyArray1::from_vec(py, column)));
        let arrays = arrays.collect();
        Ok((PyArray1::from_vec(py, columns.time), arrays))
    }
}
