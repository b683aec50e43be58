//! A second decoder: the GNU disassembler, if `OBJDUMP` names one that supports this processor (`tic6x`).
//!
//! Both decode each word in the same way, or the difference has one of the reasons in [`Reason`]; the page
//! `contributing.md` of the book describes how to get the tool and lists the reasons.

mod gnu;

use std::collections::BTreeMap;
use std::process::Command;

use c67x::{Inst, Mnemonic, Op};

use self::gnu::gnu_text;

/// The address of the words.
const PLACE: u32 = 0x1002_0000;
/// The number of words in a fetch packet; the last one is left 0, as the tool may take it for a header of compact
/// instructions.
const FETCH: usize = 8;
/// The number of random words, and of random words of each form.
const RANDOM: usize = 100_000;
const OF_FORM: usize = 100;

/// A reason why a word may be decoded differently.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Reason {
    /// The tool decodes an instruction that only later processors have.
    Later,
    /// The tool decodes a word with invalid fixed bits.
    FixedBits,
    /// Published descriptions contradict each other on the order of the sources (`c67x.md` 3.4).
    Disputed,
    /// `MVC`: control register 2 is named ISR where it is written, or the tool does not have the register.
    Control,
}

/// Forms of later processors with mnemonics that this one also has: other units, cross paths, longer constants.
const LATER: [&str; 18] = [
    "add.D", "add2.D", "add2.L", "addab.D", "addah.D", "addaw.D", "and.D", "cmpgtu.L", "cmpltu.L", "mvc.S",
    "mvk.D", "or.D", "sadd.S", "sub.D", "sub.S", "sub2.D", "sub2.L", "xor.D",
];
/// Forms that the tool decodes although bit x, or a field without an operand, has an invalid value.
const FIXED_BITS: [&str; 9] =
    ["absdp.S", "dpint.L", "dpsp.L", "dptrunc.L", "rcpdp.S", "rsqrdp.S", "sadd.L", "ssub.L", "sub.L"];

/// The reason why two decodings of a word differ; `None` if it is unknown.
fn reason(ours: Option<Inst>, theirs: Option<&str>) -> Option<Reason> {
    let Some(inst) = ours else {
        // "[!b1]add.D1Xa1,b2,a3" is of the form "add.D".
        let text = theirs?;
        let text = text.split_once(']').filter(|_| text.starts_with('[')).map_or(text, |(_, text)| text);
        let (mnemonic, rest) = text.split_once('.')?;
        let form = format!("{mnemonic}.{}", rest.get(..1)?);
        return if LATER.contains(&form.as_str()) || Mnemonic::from_name(mnemonic).is_none() {
            Some(Reason::Later)
        } else {
            FIXED_BITS.contains(&form.as_str()).then_some(Reason::FixedBits)
        };
    };
    if inst.op().is_disputed() {
        return Some(Reason::Disputed);
    }
    (inst.mnemonic() == Mnemonic::Mvc).then_some(Reason::Control)
}

/// A pseudo-random number generator with the same numbers in every run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }
}

/// The words to decode, none of them in parallel with another.
fn words() -> Vec<u32> {
    let mut numbers = Numbers(67);
    let mut words: Vec<u32> = (0..RANDOM).map(|_| numbers.next() & !1).collect();
    for op in Op::ALL {
        let row = op.row();
        words.extend((0..OF_FORM).map(|_| (row.value | numbers.next() & !row.mask) & !1));
    }
    words
}

/// The tool's decoding of each word, without blanks; `None` for a word that is not an instruction for it.
fn read_by_tool(tool: &str, words: &[u32]) -> Vec<Option<String>> {
    let mut bytes = Vec::new();
    for fetch in words.chunks(FETCH - 1) {
        bytes.extend(fetch.iter().flat_map(|word| word.to_le_bytes()));
        bytes.resize(bytes.len().next_multiple_of(4 * FETCH), 0);
    }
    let path = std::env::temp_dir().join(format!("c67x-words-{}", std::process::id()));
    std::fs::write(&path, bytes).expect("a file for the tool");
    let place = format!("--adjust-vma={PLACE}");
    let arguments = ["-D", "-z", "-b", "binary", "-m", "tic6x", "-EL", place.as_str()];
    let output = Command::new(tool).args(arguments).arg(&path).output().expect("OBJDUMP names a program");
    std::fs::remove_file(&path).expect("it was written");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    let lines = text.lines().filter_map(|line| line.trim_start().split_once(":\t"));
    let texts = lines.map(|(_, line)| {
        let text: String = line.get(8..).unwrap_or_default().split_whitespace().collect();
        (!text.starts_with("<undefined")).then_some(text)
    });
    let all: Vec<Option<String>> = texts.collect();
    all.chunks(FETCH)
        .flat_map(|fetch| &fetch[..fetch.len().min(FETCH - 1)])
        .take(words.len())
        .cloned()
        .collect()
}

/// The address of a word of [`words`].
fn place(index: usize) -> u32 {
    PLACE + 4 * (index + index / (FETCH - 1)) as u32
}

#[test]
fn random_words_are_read_as_the_gnu_disassembler_reads_them() {
    let Ok(tool) = std::env::var("OBJDUMP") else {
        eprintln!("not compared: OBJDUMP names no objdump for tic6x");
        return;
    };
    let words = words();
    let theirs = read_by_tool(&tool, &words);
    assert_eq!(theirs.len(), words.len(), "the tool has a line for each word");
    let mut counts: BTreeMap<Reason, usize> = BTreeMap::new();
    let mut unknown = Vec::new();
    for (index, (word, theirs)) in words.iter().zip(&theirs).enumerate() {
        let inst = Inst::decode(*word).ok();
        let ours = inst.map(|inst| gnu_text(inst, place(index)));
        if ours == *theirs {
            continue;
        }
        match reason(inst, theirs.as_deref()) {
            Some(reason) => *counts.entry(reason).or_default() += 1,
            None => unknown.push(format!("{word:08x}: {ours:?}, the tool {theirs:?}")),
        }
    }
    eprintln!("{} words, read differently: {counts:?}", words.len());
    assert!(unknown.is_empty(), "{} without a reason:\n{}", unknown.len(), unknown.join("\n"));
}
