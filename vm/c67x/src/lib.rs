//! The instructions of the TMS320C67x+, the processor of the board.
//!
//! The decoder, encoder, assembler, disassembler and the model of the pipeline are expanded from one table of 302 forms
//! ([`for_each_form!`]). They have three users: the engine that executes real images, the code generator that creates
//! them, and `inspect -d`.
//!
//! - [`Inst`] is one valid instruction: [`Inst::decode`] from a word, [`Inst::new`],
//!   [`Inst::pick`] and [`Inst::forms`] from operands, [`assemble`] from text.
//! - [`Inst::unit`], [`Inst::reads`], [`Inst::writes`], [`Inst::delay_slots`],
//!   [`Inst::cross_path`], [`Inst::data_path`]: properties for a scheduler.
//! - [`schedule`] checks packets against the rules of the pipeline, independently of their origin.
//!
//! Map: `register` (registers, conditions, units), `kind` (fields, kinds of operands,
//! timing), `mnemonic`, `table` (the rows), `operand`, `inst` (encode, decode), `model`
//! (the scheduler's questions), `convention` (registers of calls), `alias`, `spelling`, `assemble`, `text`, `schedule`.
//!
//! Invariants: nothing here executes anything or knows the board; only the table describes a form; an [`Inst`] is
//! always valid.
#![forbid(unsafe_code)]

mod alias;
mod assemble;
pub mod convention;
mod inst;
mod kind;
mod mnemonic;
mod model;
mod operand;
mod register;
pub mod schedule;
mod spelling;
mod table;
mod text;

pub use assemble::{AssemblyLine, SyntaxError, assemble};
pub use inst::{BadOperands, BadWord, Inst, PARALLEL};
pub use kind::{Field, Isa, Kind, Mode, OffsetKind, Stages, Timing, Update};
pub use mnemonic::Mnemonic;
pub use model::{Branch, Read, Write};
pub use operand::{Mem, Offset, Operand};
pub use register::{Control, Pair, Pred, PredReg, Reg, Side, Unit, UnitKind};
pub use spelling::{FETCH_PACKET, target};
pub use table::{Op, Row};
