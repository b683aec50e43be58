//! The call graph: the program's functions, the firmware's, and calls through pointers.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use kmotiondef::firmware::{FIRMWARE_FUNCTIONS, function_at};
use vm::operand::SigRef;
use vm::program::Program;

use super::Inspection;
use crate::bytecode::references::{Reference, reference};

/// A function and its callees.
#[derive(Debug)]
pub(super) struct Node {
    /// Its name.
    pub(super) name: String,
    /// Its address.
    pub(super) address: u32,
    /// Bytes of its frame in guest memory; `None` if its code does not show it.
    pub(super) frame: Option<u32>,
    /// The functions of the program that it calls, by number.
    pub(super) calls: BTreeSet<usize>,
    /// The functions that its calls through pointers may reach.
    pub(super) through_pointers: BTreeSet<usize>,
    /// True if it makes calls through pointers.
    pub(super) calls_pointers: bool,
    /// The firmware's functions that it calls.
    pub(super) firmware: BTreeSet<String>,
}

/// The functions of a program.
#[derive(Debug)]
pub(super) struct Calls {
    /// In the order of the text.
    pub(super) nodes: Vec<Node>,
}

impl Calls {
    pub(super) fn build(inspection: &Inspection, program: &Program) -> Self {
        let taken = addresses_taken(inspection, program);
        let nodes = program.functions().iter().map(|function| {
            let address = program.address_of(function.at.0 as usize).get();
            let mut node = Node {
                name: name(inspection, address),
                address,
                frame: Some(function.frame),
                calls: BTreeSet::new(),
                through_pointers: BTreeSet::new(),
                calls_pointers: false,
                firmware: BTreeSet::new(),
            };
            for word in function.body.clone() {
                match reference(program, word) {
                    Reference::Call(address) => node.calls.extend(function_index(program, address)),
                    Reference::Firmware(address) => {
                        node.firmware.insert(firmware_name(inspection, address));
                    }
                    Reference::Pointer(sig) => {
                        node.calls_pointers = true;
                        node.through_pointers.extend(candidates(program, sig, &taken));
                    }
                    Reference::Number(_)
                    | Reference::Float(_)
                    | Reference::Single(_)
                    | Reference::Nothing => {}
                }
            }
            node
        });
        Self { nodes: nodes.collect() }
    }

    /// The call graph, a paragraph for each function.
    pub(super) fn render(&self) -> String {
        let mut out = String::new();
        let list = |title: &str, names: Vec<&str>, out: &mut String| {
            if !names.is_empty() {
                // Writing to a string cannot fail.
                let _ = writeln!(out, "  {title} {}", names.join(", "));
            }
        };
        for node in &self.nodes {
            let name = |index: &usize| self.nodes.get(*index).map_or("?", |node| node.name.as_str());
            let _ = writeln!(out, "{}", node.name);
            list("calls", node.calls.iter().map(name).collect(), &mut out);
            list("through pointers", node.through_pointers.iter().map(name).collect(), &mut out);
            list("firmware", node.firmware.iter().map(String::as_str).collect(), &mut out);
        }
        out
    }
}

fn name(inspection: &Inspection, address: u32) -> String {
    inspection.function_name(address).map_or_else(|| format!("{address:08x}"), str::to_owned)
}

/// The name of a firmware function: the image's symbols first, then the tables.
pub(super) fn firmware_name(inspection: &Inspection, address: u32) -> String {
    let known = || Some(FIRMWARE_FUNCTIONS.get(function_at(kmotiondef::GuestAddr::new(address))?)?.name);
    match inspection.function_name(address).or_else(known) {
        Some(name) => name.to_owned(),
        None => format!("{address:08x}"),
    }
}

/// The functions whose addresses the program uses as values, by number.
fn addresses_taken(inspection: &Inspection, program: &Program) -> BTreeSet<usize> {
    let data = inspection.image.sections.iter().filter(|section| section.name != *".text");
    let words =
        data.flat_map(|section| section.data().as_chunks::<4>().0).map(|word| u32::from_le_bytes(*word));
    let immediates = (0..program.ops().len()).filter_map(|word| match reference(program, word) {
        Reference::Number(number) => Some(number),
        _ => None,
    });
    let values: BTreeSet<u32> = words.chain(immediates).collect();
    let address =
        |index: &usize| program.functions().get(*index).map(|f| program.address_of(f.at.0 as usize));
    (0..program.functions().len())
        .filter(|index| address(index).is_some_and(|at| values.contains(&at.get())))
        .collect()
}

/// The number of the function at an address.
fn function_index(program: &Program, address: u32) -> Option<usize> {
    program
        .functions()
        .iter()
        .position(|function| program.address_of(function.at.0 as usize).get() == address)
}

/// The functions that a call through a pointer with signature `sig` can mean.
fn candidates<'a>(
    program: &'a Program,
    sig: SigRef,
    taken: &'a BTreeSet<usize>,
) -> impl Iterator<Item = usize> + 'a {
    let wanted = program.signature(sig);
    taken.iter().copied().filter(move |index| {
        program
            .functions()
            .get(*index)
            .is_some_and(|function| program.signature(function.signature) == wanted)
    })
}
