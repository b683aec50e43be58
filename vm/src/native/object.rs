//! A program as an object file of the host, for the host's own linker.
//!
//! The file holds the machine code of every function under its name in the source, with `guest.` in front; the
//! image that it was made from; a [`Description`] of both; and a `main` that hands the description to the simulator
//! library, [`START`]. The library does the rest: it is the same machine, with the same firmware and clock, that
//! would otherwise translate the image when it starts.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::mem::offset_of;

use cranelift_codegen::ir::{AbiParam, InstBuilder, Signature, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::{DataDescription, DataId, FuncId, Linkage, Module, default_libcall_names};
use cranelift_object::{ObjectBuilder, ObjectModule};
use kmotiondef::{CodeAddr, GuestAddr, ThreadId};

use super::code::Entry;
use super::compile::{CodeDestination, CompileError, Functions, Job, compile, host_isa};
use super::linked::{Description, FORM};
use super::translate::{HostFunctions, PureFunctions};
use crate::program::{Function, Program};

/// The function of the simulator library that `main` calls: `int START(const Description *)`.
pub const START: &str = "cc67_run_linked";

/// What precedes the names of the program's functions, so that none is the host's `main`.
pub const PREFIX: &str = "guest.";

/// What an object file is made of.
#[derive(Clone, Copy)]
pub struct Parts<'a> {
    /// The program.
    pub program: &'a Program,
    /// The image that the program is in.
    pub image: &'a [u8],
    /// The thread that the image is linked for.
    pub thread: ThreadId,
    /// What the function at an address is called.
    pub name: &'a dyn Fn(CodeAddr) -> Option<String>,
    /// The firmware's functions that only compute.
    pub pure: &'a dyn Fn(GuestAddr) -> Option<crate::firmware::Pure>,
}

/// The object file, in the format of this computer.
///
/// # Errors
/// Where there is no machine code for this computer, or none for a function.
pub fn object(parts: Parts<'_>) -> Result<Vec<u8>, CompileError> {
    let builder = ObjectBuilder::new(host_isa(CodeDestination::File)?, "cc67", default_libcall_names())?;
    let mut writer = Writer { module: ObjectModule::new(builder) };
    let host = writer.declare()?;
    let used = RefCell::new(Vec::new());
    let functions = writer.functions(parts, HostFunctions::Table { data: host, used: &used }, parts.pure)?;
    let description = writer.description(parts, &functions, host, &used.into_inner())?;
    writer.main(description)?;
    writer.module.finish().emit().map_err(|error| CompileError::host(&error))
}

struct Writer {
    module: ObjectModule,
}

impl Writer {
    fn functions(
        &mut self,
        parts: Parts<'_>,
        host: HostFunctions<'_>,
        pure: PureFunctions<'_>,
    ) -> Result<Functions, CompileError> {
        // Sources may have a static function of the same name each.
        let taken = RefCell::new(BTreeSet::new());
        let name = |function: &Function| {
            let at = parts.program.address_of(function.at.0 as usize);
            let plain = format!("{PREFIX}{}", (parts.name)(at)?);
            let name = if taken.borrow().contains(&plain) { format!("{plain}.{at}") } else { plain };
            taken.borrow_mut().insert(name.clone());
            Some(name)
        };
        compile(&mut self.module, Job { program: parts.program, pure, host, name: &name })
    }

    fn declare(&mut self) -> Result<DataId, CompileError> {
        // Written once, before the program starts.
        Ok(self.module.declare_anonymous_data(true, false)?)
    }

    fn define(&mut self, id: DataId, data: &DataDescription) -> Result<(), CompileError> {
        Ok(self.module.define_data(id, data)?)
    }

    /// The description and all that it refers to.
    fn description(
        &mut self,
        parts: Parts<'_>,
        functions: &Functions,
        host: DataId,
        used: &[GuestAddr],
    ) -> Result<DataId, CompileError> {
        let image = self.bytes(parts.image.to_vec())?;
        let entries = self.entries(&functions.entries)?;
        self.define(host, &zeros(used.len() * size_of::<u64>()))?;
        let addresses = self.bytes(used.iter().flat_map(|addr| addr.get().to_ne_bytes()).collect())?;

        let id = self.declare()?;
        let mut numbers = vec![0; size_of::<Description>()];
        for (field, number) in [
            (offset_of!(Description, form), FORM),
            (offset_of!(Description, thread), u64::from(parts.thread.get())),
            (offset_of!(Description, image_size), parts.image.len() as u64),
            (offset_of!(Description, entry_count), functions.entries.len() as u64),
            (offset_of!(Description, host_count), used.len() as u64),
            (offset_of!(Description, native_per_guest), u64::from(functions.stack.native_per_guest)),
            (offset_of!(Description, largest_frame), u64::from(functions.stack.largest_frame)),
        ] {
            numbers[field..field + size_of::<u64>()].copy_from_slice(&number.to_ne_bytes());
        }
        let mut data = filled(numbers);
        for (field, target) in [
            (offset_of!(Description, image), image),
            (offset_of!(Description, entries), entries),
            (offset_of!(Description, host_addresses), addresses),
            (offset_of!(Description, host_pointers), host),
        ] {
            let target = self.module.declare_data_in_data(target, &mut data);
            data.write_data_addr(field as u32, target, 0);
        }
        let begin = self.module.declare_func_in_data(functions.begin, &mut data);
        data.write_function_addr(offset_of!(Description, begin) as u32, begin);
        self.define(id, &data)?;
        Ok(id)
    }

    /// The table of the functions, as [`Entry`]s.
    fn entries(&mut self, entries: &[(FuncId, FuncId)]) -> Result<DataId, CompileError> {
        let id = self.declare()?;
        let mut data = zeros(entries.len() * size_of::<Entry>());
        for ((thunk, function), place) in entries.iter().zip((0..).step_by(size_of::<Entry>())) {
            for (function, field) in
                [(thunk, offset_of!(Entry, thunk)), (function, offset_of!(Entry, pointer))]
            {
                let function = self.module.declare_func_in_data(*function, &mut data);
                data.write_function_addr((place + field) as u32, function);
            }
        }
        self.define(id, &data)?;
        Ok(id)
    }

    fn bytes(&mut self, bytes: Vec<u8>) -> Result<DataId, CompileError> {
        let id = self.module.declare_anonymous_data(false, false)?;
        self.define(id, &filled(bytes))?;
        Ok(id)
    }

    /// `int main(void) { return START(&description); }`
    fn main(&mut self, description: DataId) -> Result<(), CompileError> {
        let pointer = self.module.target_config().pointer_type();
        let mut signature: Signature = self.module.make_signature();
        signature.returns.push(AbiParam::new(types::I32));
        let main = self.module.declare_function("main", Linkage::Export, &signature)?;
        let mut context = self.module.make_context();
        context.func.signature = signature.clone();
        signature.params.push(AbiParam::new(pointer));
        let start = self.module.declare_function(START, Linkage::Import, &signature)?;

        let mut frontend = FunctionBuilderContext::new();
        let mut builder = FunctionBuilder::new(&mut context.func, &mut frontend);
        let block = builder.create_block();
        builder.switch_to_block(block);
        let description = self.module.declare_data_in_func(description, builder.func);
        let description = builder.ins().symbol_value(pointer, description);
        let start = self.module.declare_func_in_func(start, builder.func);
        let call = builder.ins().call(start, &[description]);
        let code = builder.inst_results(call)[0];
        builder.ins().return_(&[code]);
        builder.seal_all_blocks();
        builder.finalize(self.module.target_config());
        self.module.define_function(main, &mut context)?;
        Ok(())
    }
}

/// Data that begins as these bytes.
fn filled(bytes: Vec<u8>) -> DataDescription {
    let mut data = DataDescription::new();
    data.set_align(align_of::<u64>() as u64);
    data.define(bytes.into_boxed_slice());
    data
}

/// Data of this many bytes that begin as 0 or as addresses.
fn zeros(size: usize) -> DataDescription {
    filled(vec![0; size])
}
