//! Files of other tools, recognised for messages.
//!
//! "not a KFLOP image" helps less than "an ELF executable for x86-64".

use goblin::elf::header::{ET_DYN, ET_EXEC, ET_REL, et_to_str, machine_to_str};
use goblin::mach::{Mach, constants::cputype::get_arch_name_from_types};
use goblin::{Hint, Object};

/// Describes a file that is not a TI COFF, with its article; `None` if the format is unknown.
#[must_use]
pub fn describe(bytes: &[u8]) -> Option<String> {
    if bytes.is_empty() {
        return Some("an empty file".to_owned());
    }
    match Object::parse(bytes) {
        Ok(Object::Elf(elf)) => {
            let kind = match elf.header.e_type {
                ET_EXEC | ET_DYN => "program or library",
                ET_REL => "object file",
                other => et_to_str(other),
            };
            return Some(format!("an ELF {kind} for {}", machine(machine_to_str(elf.header.e_machine))));
        }
        Ok(Object::PE(pe)) => {
            let kind = if pe.is_lib { "library" } else { "program" };
            return Some(format!("a Windows {kind}"));
        }
        Ok(Object::Mach(Mach::Binary(mach))) => {
            let header = mach.header;
            let name = get_arch_name_from_types(header.cputype(), header.cpusubtype()).unwrap_or("unknown");
            return Some(format!("a macOS file for {name}"));
        }
        Ok(Object::Mach(Mach::Fat(_))) => return Some("a macOS file for several processors".to_owned()),
        Ok(Object::Archive(_)) => return Some("a library of object files".to_owned()),
        _ => {}
    }
    // A truncated or damaged file still begins with the signature of its format.
    let hint = bytes.first_chunk().and_then(|start| goblin::peek_bytes(start).ok());
    match hint {
        Some(Hint::Elf(_)) => Some("a damaged ELF file".to_owned()),
        Some(Hint::PE) => Some("a damaged Windows program".to_owned()),
        Some(Hint::Mach(_) | Hint::MachFat(_)) => Some("a damaged macOS file".to_owned()),
        Some(Hint::Archive) => Some("a damaged library of object files".to_owned()),
        _ => text(bytes),
    }
}

/// The usual name of a processor.
fn machine(name: &str) -> String {
    match name {
        "X86_64" => "x86-64".to_owned(),
        "386" => "x86".to_owned(),
        "TI_C6000" => "the C6000 DSP".to_owned(),
        other => other.to_ascii_lowercase(),
    }
}

/// Reports whether the first bytes are text.
fn text(bytes: &[u8]) -> Option<String> {
    let start = bytes.get(..bytes.len().min(512))?;
    let is_text = start.iter().all(|byte| matches!(byte, b'\t' | b'\n' | b'\r' | b' '..=b'~' | 0x80..));
    is_text.then(|| "a text file".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_described_by_their_kind() {
        let check = |bytes: &[u8], expect: Option<&str>| assert_eq!(describe(bytes).as_deref(), expect);
        check(b"", Some("an empty file"));
        check(b"int main() { }\n", Some("a text file"));
        check(&[0; 100], None);
        check(b"\x7fELF\x02\x01\x01\0\0\0\0\0\0\0\0\0", Some("a damaged ELF file"));
        check(b"!<arch>\nand no member header", Some("a damaged library of object files"));
        let mut elf = vec![0; 64];
        elf[..7].copy_from_slice(b"\x7fELF\x02\x01\x01");
        elf[16..21].copy_from_slice(&[1, 0, 62, 0, 1]);
        elf[52] = 64;
        check(&elf, Some("an ELF object file for x86-64"));
    }
}
