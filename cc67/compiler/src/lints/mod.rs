//! Searches for mistakes in programs; the list of all warnings is [`Lint`](crate::diag::Lint).
//!
//! A lint that needs its own search has a file in this folder: a pass over the finished typed tree, named in its row,
//! or a `finding` that semantic analysis calls where it has the syntax. A mistake that semantic analysis detects anyway
//! is reported there.

mod call_graph;
mod changes;
mod flow;
mod program;
mod used_values;
mod walk;

mod absolute_time;
mod adc_counts;
mod array_bounds;
mod board_format;
mod box_answer;
mod call_back_wait;
mod constant_comparison;
mod copied_axis;
mod degrees;
mod early_answer;
mod endless_wait;
mod fall_through;
mod file_name;
mod firmware_name;
mod float_counter;
mod float_equality;
mod float_time;
mod format;
mod gather_early;
mod header_mismatch;
mod idle_loop;
mod integer_division;
mod kept_counter;
mod local_lock;
mod loop_condition;
mod lost_fraction;
mod lost_swap;
mod milliseconds;
mod missing_call;
mod missing_return;
mod narrow_type;
mod negative_comparison;
mod parameter_copy;
mod portability;
mod recursion;
mod returned_local;
mod self_comparison;
mod shadow;
mod slow_callback;
mod stack_size;
mod stale_position;
mod stale_sum;
mod text_comparison;
mod text_overflow;
mod uninitialized;
mod unreachable_code;
mod unsequenced;
mod unused_copy;
mod unused_variable;
mod user_data_pointer;
mod user_data_type;
mod vendor_parameter;
mod void_main;
mod wait_for_any;

pub(crate) mod assignment_condition;
pub(crate) mod constant_conversion;
pub(crate) mod conversion;
pub(crate) mod dangling_else;
pub(crate) mod duplicated_condition;
pub(crate) mod empty_body;
pub(crate) mod logical_constant;
pub(crate) mod macro_parentheses;
pub(crate) mod misleading_indentation;
pub(crate) mod missing_address;
pub(crate) mod multistatement_macro;
pub(crate) mod octal;
pub(crate) mod overflow;
pub(crate) mod power;
pub(crate) mod precedence;
pub(crate) mod reversed_operator;
pub(crate) mod sign_compare;
pub(crate) mod sizeof_pointer;
pub(crate) mod unused_label;
pub(crate) mod unused_value;
pub(crate) mod user_data_alignment;
pub(crate) mod user_data_index;
pub(crate) mod value_range;
pub(crate) mod vendor;

use program::AnalysedProgram;

use crate::diag::{Sink, for_each_lint};
use crate::firmware::FirmwareNames;
use crate::names::Names;
use crate::source::SourceMap;
use crate::typed::Unit;

/// A search through a program.
type Pass = fn(&AnalysedProgram<'_>, &mut Sink);

macro_rules! list_passes {
    ($($(#[doc = $doc:literal])+ $variant:ident = $name:literal, $preset:ident $(, pass $pass:ident)?;)*) => {
        /// The searches, in the order of the table.
        const PASSES: &[Pass] = &[$($($pass::check,)?)*];
    };
}
for_each_lint!(list_passes);

/// The board that a program is for, as far as lints look at it.
#[derive(Clone, Copy)]
pub struct LintContext<'a> {
    /// The names of its firmware.
    pub firmware: &'a dyn FirmwareNames,
    /// The elements of `persist.UserData` in which a `float` is stored before the program starts.
    pub float_elements: &'a [u32],
}

/// Runs every pass over a program that was analysed.
pub fn check(unit: &Unit, names: &Names, sources: &SourceMap, context: LintContext<'_>, sink: &mut Sink) {
    let LintContext { firmware, float_elements } = context;
    let program = AnalysedProgram { unit, names, sources, firmware, float_elements };
    PASSES.iter().for_each(|pass| pass(&program, sink));
}
