//! `setjmp` and `longjmp` for the controller's processor, which cannot be written in C.
//!
//! A `jmp_buf` holds the callee-saved state (`c67x.md` section 6.1): A10 to A15, B10 to B14, the stack pointer, the
//! return address. Bytecode has no such code: its engine implements both functions.

use kmotiondef::jumps::JumpFunction;

use crate::c67x::text::assemble_words;
use crate::ir::function::Signature;
use crate::ir::inst::Class;
use crate::object::{Definition, Line, Object, ObjectFunction, SourceLine, Symbol, SymbolKind};
use crate::typed::Linkage;

/// The file to which their lines belong.
const FILE: &str = "setjmp.s";

/// The code that saves the registers. The last stores are in the delay slots of the branch.
const SET: &str = "
    STW .D1T1 A10,*+A4[0]
    STW .D1T1 A11,*+A4[1]
    STW .D1T1 A12,*+A4[2]
    STW .D1T1 A13,*+A4[3]
    STW .D1T1 A14,*+A4[4]
    STW .D1T1 A15,*+A4[5]
    STW .D1T2 B10,*+A4[6]
    STW .D1T2 B11,*+A4[7]
    STW .D1T2 B12,*+A4[8]
    STW .D1T2 B13,*+A4[9]
    B .S2 B3
    STW .D1T2 B14,*+A4[10]
    STW .D1T2 B15,*+A4[11]
    STW .D1T2 B3,*+A4[12]
    MVK .S1 0,A4
    NOP 1
";

/// The code that restores them. The stack pointer is loaded in the delay slots of the branch: no interrupt sees half of
/// a change.
const LONG: &str = "
    LDW .D1T2 *+A4[12],B3
    LDW .D1T1 *+A4[0],A10
    LDW .D1T1 *+A4[1],A11
    LDW .D1T1 *+A4[2],A12
    LDW .D1T1 *+A4[3],A13
    LDW .D1T1 *+A4[4],A14
    LDW .D1T1 *+A4[5],A15
    LDW .D1T2 *+A4[6],B10
    LDW .D1T2 *+A4[7],B11
    LDW .D1T2 *+A4[8],B12
    LDW .D1T2 *+A4[9],B13
    LDW .D1T2 *+A4[10],B14
    B .S2 B3
    || LDW .D1T2 *+A4[11],B15
    MV .S2 B4,B0
    MV .S1X B4,A4
    [!B0] MVK .S1 1,A4
    NOP 2
";

/// The object that defines both.
pub(super) fn object() -> Object {
    let mut object = Object { files: vec![FILE.to_owned()], code: Some(Vec::new()), ..Object::default() };
    for function in JumpFunction::ALL {
        add(&mut object, function);
    }
    object
}

/// Adds one of them.
fn add(object: &mut Object, function: JumpFunction) {
    let words = assemble_words(match function {
        JumpFunction::Set => SET,
        JumpFunction::Long => LONG,
    });
    let code = object.code.get_or_insert_default();
    code.resize(code.len().next_multiple_of(crate::c67x::ALIGN as usize), 0);
    let start = code.len() as u32;
    code.extend(words);
    let end = code.len() as u32;
    let place = SourceLine { file: 0, line: object.functions.len() as u32 + 1 };
    let symbol = object.symbols.push(Symbol {
        name: function.name().to_owned(),
        linkage: Linkage::External,
        definition: Definition::Function(object.functions.len() as u32),
        kind: SymbolKind::Function,
        size: 0,
        align: 1,
        span: None,
        place,
        used_at: None,
    });
    let signature = object.signatures.intern(&signature(function));
    let first = object.lines.len() as u32;
    object.lines.push(Line { word: start, place, column: 0 });
    object.functions.push(ObjectFunction {
        symbol,
        signature,
        words: start..end,
        relocations: 0..0,
        lines: first..first + 1,
        frame: 0,
        end: place,
        variables: Vec::new(),
        inlined: Vec::new(),
        exceeded: Vec::new(),
    });
}

/// The signature of a jump function.
fn signature(function: JumpFunction) -> Signature {
    Signature {
        params: vec![Class::I32; function.parameters()],
        result: function.has_result().then_some(Class::I32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_an_instruction_and_no_result_is_read_too_early() {
        let object = object();
        let code = object.code.expect("it is for the processor");
        for (function, text) in object.functions.iter().zip([SET, LONG]) {
            let words = &code[function.words.start as usize..function.words.end as usize];
            assert_eq!(words.len(), text.trim().lines().count());
            let packets = c67x::schedule::packets(words).expect("instructions");
            let found = c67x::schedule::check(0, &packets, &[0]);
            let found: Vec<_> = found.iter().map(ToString::to_string).collect();
            assert!(found.is_empty(), "{found:?}");
        }
    }
}
