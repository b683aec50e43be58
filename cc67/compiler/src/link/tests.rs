//! Names, placement, sizes and messages.

use kmotiondef::timing::Timing;
use kmotiondef::{GuestAddr, ThreadId};

use super::{LinkError, LinkedProgram, Options, Section, SectionAddresses, link};
use crate::diag::Sink;
use crate::driver::generate;
use crate::firmware::{FirmwareKind, FirmwareSymbol, FirmwareSymbols};
use crate::ir::function::Signature;
use crate::ir::inst::Class;
use crate::lower::testing;
use crate::object::Object;
use crate::passes::Level;

/// `SetBit` at 0x80001000 and `persist` at 0x10001040.
struct Fake;

impl FirmwareSymbols for Fake {
    fn find(&self, name: &str) -> Option<FirmwareSymbol> {
        let symbol = |address, kind| Some(FirmwareSymbol { address: GuestAddr::new(address), kind });
        let signature = Signature { params: vec![Class::I32], result: None };
        match name {
            "SetBit" => symbol(0x8000_1000, FirmwareKind::Function(Some(signature))),
            "persist" => symbol(0x1000_1040, FirmwareKind::Variable),
            _ => None,
        }
    }

    fn symbol_names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        Box::new(["SetBit", "persist"].into_iter())
    }
}

fn object(source: &str) -> Object {
    let (unit, sources) = testing::unit(source);
    generate(&unit, &sources, Level::Full, Timing::Fast, &mut Sink::new())
}

fn try_link(sources: &[&str], thread: i32, gc: bool) -> Result<LinkedProgram, Vec<LinkError>> {
    let objects: Vec<Object> = sources.iter().map(|source| object(source)).collect();
    let thread = ThreadId::new(thread).expect("1 to 7");
    link(&objects, &Options { thread, firmware: &Fake, gc, addresses: SectionAddresses::default() })
}

fn linked(sources: &[&str]) -> LinkedProgram {
    try_link(sources, 1, true).expect("links")
}

/// The address of a symbol.
fn address(linked: &LinkedProgram, name: &str) -> u32 {
    linked.symbols.iter().find(|symbol| symbol.name == name).map_or(0, |symbol| symbol.address.get())
}

/// The word in the data at the symbol `name`.
fn word(linked: &LinkedProgram, name: &str) -> u32 {
    let at = (address(linked, name) - linked.data.address.get()) as usize;
    linked.data.bytes[at..].first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

fn check_errors(sources: &[&str], expected: &[&str]) {
    let errors = try_link(sources, 1, true).expect_err("does not link");
    let messages: Vec<String> = errors.iter().map(ToString::to_string).collect();
    assert_eq!(messages, expected);
}

#[test]
fn sections_follow_each_other_at_multiples_of_32() {
    let linked = linked(&["char c = 1; double d = 2; int b[3]; main() { return c + d + b[0]; }"]);
    assert_eq!(linked.text.address, GuestAddr::new(0x8005_0000));
    let text_end = linked.text.address.get() + linked.text.bytes.len() as u32;
    assert_eq!(linked.data.address.get(), text_end.next_multiple_of(32));
    assert_eq!(address(&linked, "d"), linked.data.address.get() + 8);
    assert_eq!(linked.data.bytes.len(), 16);
    assert_eq!(linked.bss.address.get(), linked.data.address.get() + 32);
    assert_eq!(linked.bss.size, 12);
    let sections: Vec<Section> = linked.symbols.iter().map(|symbol| symbol.section).collect();
    assert_eq!(sections, [Section::Text, Section::Data, Section::Data, Section::Bss]);
}

#[test]
fn statics_are_resolved_in_their_unit_and_externals_across_units() {
    let linked = linked(&[
        "static int s = 1; int *a = &s; int shared; int g(void); main() { shared = *a; return g(); }",
        "static int s = 2; int *b = &s; extern int *a; int shared; int g(void) { return *a + *b + shared; }",
    ]);
    assert_ne!(word(&linked, "a"), word(&linked, "b"));
    assert_eq!(linked.symbols.iter().filter(|symbol| symbol.name == "shared").count(), 1);
}

#[test]
fn an_initialised_definition_wins_over_the_largest_tentative_one() {
    let linked = linked(&["char a[4]; int b; main() { return a[0] + b; }", "char a[9]; int b = 7; "]);
    let size =
        |name: &str| linked.symbols.iter().find(|symbol| symbol.name == name).map(|symbol| symbol.size);
    assert_eq!(size("a"), Some(9));
    assert_eq!(word(&linked, "b"), 7);
}

#[test]
fn data_hold_addresses_of_objects_functions_and_the_firmware() {
    let linked = linked(&[
        "extern int persist[]; int f(void) { return 0; } int t[4]; int *p = &t[2]; int (*q)(void) = f;
         int *r = &persist[3]; main() { return *p + q() + *r; }",
    ]);
    assert_eq!(word(&linked, "p"), address(&linked, "t") + 8);
    assert_eq!(word(&linked, "q"), address(&linked, "f"));
    assert_eq!(word(&linked, "r"), 0x1000_104c);
    assert_eq!(linked.firmware.imports.len(), 1);
}

#[test]
fn a_programs_own_definition_wins_over_the_firmwares() {
    let linked = linked(&["int persist = 5; void SetBit(int bit) { persist = bit; } main() { SetBit(1); }"]);
    assert_eq!(linked.firmware.imports, []);
}

#[test]
fn symbols_unreachable_from_main_are_left_out_on_request() {
    let source = "int used = 1, unused = 2; int f(void) { return unused; } main() { return used; }";
    assert_eq!(linked(&[source]).symbols.len(), 2);
    assert_eq!(try_link(&[source], 1, false).map(|linked| linked.symbols.len()), Ok(4));
}

#[test]
fn main_may_be_static_and_need_not_come_first() {
    let linked = linked(&["int f(void) { return 1; } static int main() { return f(); }"]);
    let (main, _) = vm::guard::split(&linked.text.bytes).expect("the text is bytecode");
    assert_eq!(main.get(), address(&linked, "main"));
    assert_eq!(linked.entry, linked.text.address);
}

#[test]
fn everything_undefined_is_reported_at_once_with_its_first_use() {
    let source = "void Setbit(int); extern int x; main() {\n Setbit(1);\n x = 1; Setbit(2); x = 2; }";
    check_errors(&[source], &["undefined symbol `Setbit`", "undefined symbol `x`"]);
    let errors = try_link(&[source], 1, true).expect_err("does not link");
    let at = source.find("Setbit(1)").map(|at| at as u32);
    assert_eq!(errors[0].span.map(|span| span.lo), at);
    assert_eq!(errors[0].to_diagnostic().help.as_deref(), Some("did you mean `SetBit`?"));
}

#[test]
fn other_errors_are_named() {
    check_errors(&["int f(void) { return 1; }"], &["no `main`"]);
    check_errors(
        &["int a = 1; main() { }", "int a = 2;"],
        &["`a` is defined twice, in test.c:1 and in test.c:1"],
    );
    check_errors(
        &["int SetBit(double); main() { return SetBit(1.0); }"],
        &["`SetBit` is called as `i32 (f64)`, but is `void (i32)`"],
    );
    check_errors(
        &["void persist(void); main() { persist(); }"],
        &["`persist` is called, but is not a function"],
    );
}

#[test]
fn a_program_larger_than_its_space_extends_into_the_next_ones() {
    let source = "char a[200000]; main() { a[0] = 1; }";
    let linked = try_link(&[source], 2, true).expect("links");
    let warning = linked.warnings.first().map(ToString::to_string).unwrap_or_default();
    assert!(warning.ends_with("enters the space of thread 3, 4, 5"), "{warning}");
    let notes = linked.warnings.first().map(|warning| warning.to_diagnostic().notes).unwrap_or_default();
    assert!(notes[0].starts_with("the largest parts in bytes: a (200000), main ("), "{notes:?}");
    let source = "char a[400000]; main() { a[0] = 1; }";
    let errors = try_link(&[source], 7, true).expect_err("does not fit");
    let message = errors[0].to_diagnostic();
    assert!(
        message.message.ends_with("bytes too large for the 327680 bytes after its address"),
        "{}",
        message.message
    );
    assert!(
        message.notes[0].starts_with("the largest parts in bytes: a (400000), main ("),
        "{:?}",
        message.notes
    );
}

#[test]
fn sizes_up_to_the_limit_give_no_warning() {
    let fits = |size: u32| try_link(&[&format!("char a[{size}]; main() {{ a[0] = 1; }}")], 1, true);
    let text = fits(1).expect("links");
    let room = 0x1_0000 - (text.bss.address.get() - text.text.address.get());
    assert_eq!(fits(room).map(|linked| linked.warnings.len()), Ok(0));
    assert_eq!(fits(room + 1).map(|linked| linked.warnings.len()), Ok(1));
}
