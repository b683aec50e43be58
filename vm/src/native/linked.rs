//! A program whose machine code is part of this executable.
//!
//! `cc67 build --emit native` has made the code and the [`Description`] ([`object`](super::object)). The executable
//! makes an engine with it ([`NativeEngine::with_linked`](super::NativeEngine::with_linked)); whenever a thread starts a
//! program on that engine which equals the one in the image, that code runs instead of one that is translated now.
#![expect(unsafe_code, reason = "follows the pointers of an object file that was linked with this library")]

use std::slice;
use std::sync::Arc;
use std::sync::atomic::{AtomicPtr, Ordering};

use kmotiondef::{GuestAddr, ThreadId};

use super::code::{Entry, MachineCode, begin_at};
use super::compile::StackUse;
use super::state::State;
use super::translate::PureFunctions;
use crate::for_each_op;
use crate::program::Program;

/// What the object file says of itself. All fields have eight bytes.
#[derive(Debug)]
#[repr(C)]
pub struct Description {
    /// [`FORM`] of what made the file.
    pub(super) form: u64,
    /// The thread that the image is for.
    pub(super) thread: u64,
    /// The image.
    pub(super) image: *const u8,
    pub(super) image_size: u64,
    /// What begins the outermost call.
    pub(super) begin: *const u8,
    /// The functions, in the order of the program.
    pub(super) entries: *const Entry,
    pub(super) entry_count: u64,
    /// The firmware's functions that the code calls by itself, and where it looks for them.
    pub(super) host_addresses: *const u32,
    pub(super) host_pointers: *const AtomicPtr<()>,
    pub(super) host_count: u64,
    /// What calls take of the native stack.
    pub(super) native_per_guest: u64,
    pub(super) largest_frame: u64,
}

const _: () = assert!(size_of::<*const u8>() == size_of::<u64>(), "Cranelift has code for 64-bit hosts only");

macro_rules! count_ops {
    ($($(#[$doc:meta])* $name:ident = $variant:ident { $($field:ident: $operand:ident),* }, cost $cost:expr, $kind:ident $(($fact:ident))?;)*) => {
        /// The instructions there are.
        const OPS: &[&str] = &[$(stringify!($name)),*];
    };
}
for_each_op!(count_ops);

/// A number that differs between versions of this library whose code does not go together: what compiled code knows
/// of the library is the layout of the state.
pub(super) const FORM: u64 = form();

const fn form() -> u64 {
    // FNV-1a (Fowler, Noll, Vo).
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let version = env!("CARGO_PKG_VERSION").as_bytes();
    let mut index = 0;
    while index < version.len() {
        hash = (hash ^ version[index] as u64).wrapping_mul(0x100_0000_01b3);
        index += 1;
    }
    let numbers = [
        size_of::<State>(),
        std::mem::offset_of!(State, exchange.request),
        size_of::<Description>(),
        OPS.len(),
    ];
    let mut index = 0;
    while index < numbers.len() {
        hash = (hash ^ numbers[index] as u64).wrapping_mul(0x100_0000_01b3);
        index += 1;
    }
    hash
}

/// Why the code of an executable cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinkedError {
    /// The object file was made by another version.
    #[error(
        "the object file and the simulator library are from different versions of cc67; build the object file again"
    )]
    Form,
    /// The code is that of another program.
    #[error("the machine code in the object file is not that of its image")]
    Program,
}

/// The program of this executable.
#[derive(Debug)]
pub struct Linked {
    image: &'static [u8],
    thread: ThreadId,
    code: Arc<MachineCode>,
    host: Vec<(GuestAddr, &'static AtomicPtr<()>)>,
}

impl Linked {
    /// What `description` describes.
    ///
    /// # Errors
    /// [`LinkedError::Form`] if another version of cc67 has made it.
    ///
    /// # Safety
    /// `description` points to what [`object`](super::object::object) has written, unchanged, in an object file that
    /// is part of this executable.
    pub unsafe fn new(description: *const Description) -> Result<Self, LinkedError> {
        // SAFETY: the caller vouches for the pointer; nothing writes to what it points to.
        let description: &'static Description = unsafe { &*description };
        let Some(thread) = i32::try_from(description.thread).ok().and_then(ThreadId::new) else {
            return Err(LinkedError::Form);
        };
        if description.form != FORM {
            return Err(LinkedError::Form);
        }
        // SAFETY: the file has so many bytes there; an object file of the same form means the same by it.
        let image = unsafe { table(description.image, description.image_size) };
        // SAFETY: the same for its table of functions.
        let entries = unsafe { table(description.entries, description.entry_count) };
        // SAFETY: the same for its table of addresses.
        let addresses = unsafe { table(description.host_addresses, description.host_count) };
        // SAFETY: the same for its table of pointers, which it alone keeps in memory that can be written.
        let pointers = unsafe { table(description.host_pointers, description.host_count) };
        let code = MachineCode {
            _memory: None,
            begin: begin_at(description.begin),
            entries: entries.to_vec(),
            stack: StackUse {
                native_per_guest: description.native_per_guest as u32,
                largest_frame: description.largest_frame as u32,
            },
        };
        let host = addresses.iter().map(|addr| GuestAddr::new(*addr)).zip(pointers).collect();
        Ok(Self { image, thread, code: Arc::new(code), host })
    }

    /// The image.
    #[must_use]
    pub const fn image(&self) -> &'static [u8] {
        self.image
    }

    /// The thread that it is linked for.
    #[must_use]
    pub const fn thread(&self) -> ThreadId {
        self.thread
    }

    /// The code of `program`, which is that of the image, with the functions of `pure` as it calls them.
    pub(super) fn code_for(
        &self,
        program: &Program,
        pure: PureFunctions<'_>,
    ) -> Result<Arc<MachineCode>, LinkedError> {
        if self.code.entries.len() != program.functions().len() {
            return Err(LinkedError::Program);
        }
        for (addr, place) in &self.host {
            let function =
                pure(*addr).and_then(|pure| pure.function.pointer()).ok_or(LinkedError::Program)?;
            place.store(function.cast_mut(), Ordering::Relaxed);
        }
        Ok(Arc::clone(&self.code))
    }
}

/// A table of an object file.
///
/// # Safety
/// `first` is that of `count` values, which stay there and are changed as their type allows only.
unsafe fn table<T>(first: *const T, count: u64) -> &'static [T] {
    if count == 0 {
        return &[];
    }
    // SAFETY: the caller vouches for both.
    unsafe { slice::from_raw_parts(first, count as usize) }
}
