//! `setjmp` and `longjmp`: return into an active call, past the calls that it has made.
//!
//! The state that `setjmp` saves is in the context, not in the guest's memory: a program can neither forge a jump point
//! nor change the registers of a call. The `jmp_buf` holds a number, the context to which it belongs, and the
//! complement of the number, which distinguishes it from uninitialised memory. A call with a jump point has a mark; the
//! point is dropped when the call at its depth has another mark.

use kmotiondef::GuestAddr;
use kmotiondef::jumps::JumpFunction;

use super::context::Context;
use crate::engine::{ContextId, Slice};
use crate::firmware::{Firmware, Signature};
use crate::kind::Width;
use crate::operand::Class;
use crate::slot::Slot;
use crate::trap::TrapKind;

/// Most places of a context in calls that have not returned.
const MOST: usize = 1000;

/// A target of `longjmp`.
#[derive(Clone, Debug)]
pub(super) struct JumpPoint {
    /// The `jmp_buf`.
    pub(super) place: GuestAddr,
    /// The mark of its call.
    pub(super) mark: u16,
    /// Number of calls around its call.
    pub(super) depth: usize,
    /// The instruction after the call of `setjmp`.
    pub(super) pc: usize,
    /// The registers of its call at that time.
    pub(super) registers: Box<[u64]>,
}

/// The places of a context.
#[derive(Clone, Debug, Default)]
pub(super) struct Jumps {
    /// By ascending number.
    points: Vec<(u32, JumpPoint)>,
    /// The number of the last one.
    last: u32,
}

impl Jumps {
    /// Drops all jump points. Their numbers are not reused.
    pub(super) fn clear(&mut self) {
        self.points.clear();
    }

    /// Keeps only the jump points that are live.
    pub(super) fn retain(&mut self, is_live: impl Fn(&JumpPoint) -> bool) {
        self.points.retain(|(_, point)| is_live(point));
    }

    /// A mark that no call with a place has.
    pub(super) fn free_mark(&self) -> u16 {
        let is_free = |mark: &u16| self.points.iter().all(|(_, point)| point.mark != *mark);
        (1..).find(is_free).expect("there are fewer places than marks")
    }

    /// Saves a jump point and returns its number; a jump point set again at the same place, as in a loop, keeps its
    /// number.
    ///
    /// # Errors
    /// [`TrapKind::TooManyJumpPlaces`]
    pub(super) fn keep(&mut self, point: JumpPoint) -> Result<u32, TrapKind> {
        let is_same = |(_, known): &&mut (u32, JumpPoint)| {
            (known.mark, known.pc, known.place) == (point.mark, point.pc, point.place)
        };
        if let Some((number, known)) = self.points.iter_mut().find(is_same) {
            *known = point;
            return Ok(*number);
        }
        if self.points.len() == MOST {
            return Err(TrapKind::TooManyJumpPlaces { most: MOST });
        }
        self.last = self.last.wrapping_add(1);
        self.points.push((self.last, point));
        Ok(self.last)
    }

    /// The place with a number.
    pub(super) fn find(&self, number: u32) -> Option<&JumpPoint> {
        self.points.iter().find(|(known, _)| *known == number).map(|(_, point)| point)
    }
}

/// Executes the call of `function` at the current instruction of `context`, which then continues after the call, or at
/// the target of `longjmp`.
///
/// # Errors
/// The jump buffer cannot be written or read, its jump point is no longer valid, or `called` is not the function's
/// signature.
pub(super) fn call<F: Firmware + ?Sized>(
    id: ContextId,
    function: JumpFunction,
    called: &Signature,
    context: &mut Context,
    slice: &mut Slice<'_, F>,
) -> Result<(), TrapKind> {
    let signature = Signature {
        params: vec![Class::I32; function.parameters()],
        result: function.has_result().then_some(Class::I32),
    };
    signature.check_call(function.address(), called)?;
    slice.budget -= function.cost();
    let place = GuestAddr::from_slot(context.arguments(1)[0]);
    let own = id.index() as u32;
    match function {
        JumpFunction::Set => {
            let number = context.set_jump(place)?;
            for (offset, word) in [(0, number), (4, own), (8, !number)] {
                slice.store_slot(place.offset(offset), Width::I32, u64::from(word))?;
            }
            context.calls.result = 0;
            context.calls.pc += 1;
        }
        JumpFunction::Long => {
            let value = i32::from_slot(context.arguments(2)[1]);
            let mut word = |offset| -> Result<u32, TrapKind> {
                Ok(slice.load_slot(place.offset(offset), Width::I32)? as u32)
            };
            let (number, thread, complement) = (word(0)?, word(4)?, word(8)?);
            if number != !complement {
                return Err(TrapKind::NoJumpPlace { addr: place });
            }
            if thread != own {
                return Err(TrapKind::ForeignJumpPlace { addr: place });
            }
            if !context.long_jump(number) {
                return Err(TrapKind::JumpAfterReturn { addr: place });
            }
            context.calls.result = (if value == 0 { 1 } else { value }).into_slot();
        }
    }
    Ok(())
}
