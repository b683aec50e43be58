//! Words of other languages and boards, and their counterparts in a program for KFLOP.
//!
//! People come to KFLOP from Arduino, C++, Python, Basic and G-code, and use the words they know; or they copy a call
//! from an example of the manual without the function. A row of [`WORDS`] is such a word with its replacement.

/// The origin of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Origin {
    /// Arduino sketches.
    Arduino,
    /// C++.
    Cpp,
    /// Python, Basic and languages like them.
    Script,
    /// C on computers.
    Computer,
    /// Examples of the manual, which define it themselves.
    Example,
    /// Names that people expect in the firmware, by the pattern of existing ones.
    Board,
    /// Script commands of the board's console.
    Console,
}

/// A word that the board's C does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The word.
    pub spelling: &'static str,
    /// Its origin.
    pub origin: Origin,
    /// It accompanies other words of its origin, so it is not reported after one of them.
    pub is_companion: bool,
    /// The replacement.
    pub advice: &'static str,
}

/// The row of a word, if it has one.
#[must_use]
pub fn word(spelling: &str) -> Option<&'static Word> {
    WORDS.iter().find(|word| word.spelling == spelling)
}

const fn lead_word(spelling: &'static str, origin: Origin, advice: &'static str) -> Word {
    Word { spelling, origin, is_companion: false, advice }
}

const fn companion_word(spelling: &'static str, origin: Origin, advice: &'static str) -> Word {
    Word { spelling, origin, is_companion: true, advice }
}

use Origin::{Arduino, Board, Computer, Console, Cpp, Example, Script};

/// The advice for functions that send requests to the PC.
const PC_REQUESTS: &str =
    "take it from the manual's example `KFLOPtoPCCmdExamples.c`, or `#include` a file that defines it";

const NO_KEYBOARD: &str = "a program has no keyboard; `persist.UserData` holds what the PC sends";

const TEXT_FILES: &str = "files of the PC are text: `fprintf` writes them, `fgets` and `fscanf` read them";

const JUMPS: &str = "`#include <setjmp.h>` declares it";

/// Every word, by origin.
const WORDS: &[Word] = &[
    lead_word("delay", Arduino, "`Delay_sec(0.1)` waits a tenth of a second"),
    lead_word(
        "delayMicroseconds",
        Arduino,
        "`Delay_sec(0.001)` waits a millisecond; a thread runs every 180 µs or later",
    ),
    lead_word("millis", Arduino, "`Time_sec()` is the time in seconds"),
    lead_word("micros", Arduino, "`Time_sec()` is the time in seconds"),
    lead_word("digitalWrite", Arduino, "write `SetBit(46)`, `ClearBit(46)` or `SetStateBit(46, value)`"),
    lead_word("digitalRead", Arduino, "`ReadBit(46)` reads an input"),
    lead_word("pinMode", Arduino, "`SetBitDirection(46, 1)` makes bit 46 an output, 0 an input"),
    lead_word("analogRead", Arduino, "`ADC(channel)` is the last conversion of a channel"),
    lead_word("analogWrite", Arduino, "`DAC(channel, counts)` sets an analog output"),
    lead_word("Serial", Arduino, "`printf` writes to the console"),
    companion_word("HIGH", Arduino, "an output is 1 or 0"),
    companion_word("LOW", Arduino, "an output is 1 or 0"),
    companion_word("OUTPUT", Arduino, "`SetBitDirection(46, 1)` makes bit 46 an output"),
    companion_word("INPUT", Arduino, "`SetBitDirection(46, 0)` makes bit 46 an input"),
    lead_word("cout", Cpp, "`printf(\"%f\\n\", value)` writes to the console"),
    lead_word("cin", Cpp, NO_KEYBOARD),
    companion_word("endl", Cpp, "a line ends in `\\n`"),
    companion_word("std", Cpp, "C has no namespaces"),
    lead_word("new", Cpp, "give an array a fixed size, such as `double samples[100];`"),
    companion_word("delete", Cpp, "memory is not allocated, so it is not freed"),
    lead_word("nullptr", Cpp, "write `NULL`"),
    lead_word("this", Cpp, "C has no classes; pass a pointer to a `struct`"),
    lead_word("print", Script, "`printf(\"%f\\n\", value)` writes to the console"),
    lead_word("sleep", Computer, "`Delay_sec(1.0)` waits a second"),
    lead_word("Sleep", Computer, "`Delay_sec(1.0)` waits a second"),
    lead_word("usleep", Computer, "`Delay_sec(0.001)` waits a millisecond"),
    lead_word("clock", Computer, "`Time_sec()` is the time in seconds"),
    lead_word("getchar", Computer, NO_KEYBOARD),
    lead_word("gets", Computer, NO_KEYBOARD),
    lead_word("scanf", Computer, NO_KEYBOARD),
    lead_word("stdin", Computer, NO_KEYBOARD),
    lead_word("stdout", Computer, "`printf` writes to the console"),
    lead_word("stderr", Computer, "`printf` writes to the console"),
    lead_word("fputs", Computer, "`fprintf(file, \"%s\", text)` writes to a file of the PC"),
    lead_word("fread", Computer, TEXT_FILES),
    lead_word("fwrite", Computer, TEXT_FILES),
    lead_word("fseek", Computer, TEXT_FILES),
    lead_word("setjmp", Computer, JUMPS),
    lead_word("longjmp", Computer, JUMPS),
    lead_word("strtof", Computer, "`strtod` reads a number"),
    lead_word("None", Script, "write `NULL`, or 0 for a number"),
    lead_word("True", Script, "use `TRUE` of `KMotionDef.h`, or 1"),
    lead_word("False", Script, "use `FALSE` of `KMotionDef.h`, or 0"),
    lead_word("and", Script, "write `&&`"),
    lead_word("or", Script, "write `||`"),
    lead_word("not", Script, "write `!`"),
    lead_word("true", Computer, "use `TRUE` of `KMotionDef.h`, or 1"),
    lead_word("false", Computer, "use `FALSE` of `KMotionDef.h`, or 0"),
    lead_word("MsgBox", Example, PC_REQUESTS),
    lead_word("MDI", Example, PC_REQUESTS),
    lead_word("DoPC", Example, PC_REQUESTS),
    lead_word("DoPCInt", Example, PC_REQUESTS),
    lead_word("DoPCFloat", Example, PC_REQUESTS),
    lead_word("GetBit", Board, "`ReadBit(bit)` is the level of a bit"),
    lead_word("GetBitState", Board, "`ReadBit(bit)` is the level of a bit"),
    lead_word("ReadInput", Board, "`ReadBit(bit)` is the level of a bit"),
    lead_word("WriteBit", Board, "`SetStateBit(bit, level)` sets a bit to a level"),
    lead_word("ToggleBit", Board, "`SetStateBit(bit, !ReadBit(bit))` toggles a bit"),
    lead_word("GetADC", Board, "`ADC(channel)` is the last conversion of a channel"),
    lead_word("MoveXYZ", Board, "`MoveXYZABC(x, y, z, a, b, c)` moves the axes of the coordinate system"),
    lead_word("MoveTo", Board, "`Move(axis, position)` starts a move"),
    lead_word("MoveAbs", Board, "`Move(axis, position)` starts a move"),
    lead_word("StopAxis", Board, "`Jog(axis, 0.0)` brings an axis to a stop"),
    lead_word("Stop", Board, "`Jog(axis, 0.0)` brings an axis to a stop"),
    lead_word("Home", Board, "there is no function for homing; `cc67 --explain homing` shows a program"),
    lead_word("Wait", Board, "`Delay_sec(0.1)` waits a tenth of a second"),
    lead_word("Delay", Board, "`Delay_sec(0.1)` waits a tenth of a second"),
    lead_word("GetTime", Board, "`Time_sec()` is the time in seconds"),
    lead_word("KillThread", Board, "`PauseThread(thread)` stops a thread"),
    lead_word("StopThread", Board, "`PauseThread(thread)` stops a thread"),
    lead_word("Pos", Console, "`Pos` is a script command of the console; in C write `ch0->Position`"),
    lead_word(
        "Execute",
        Console,
        "`Execute` is a script command of the console; in C write `StartThread(thread)`",
    ),
    lead_word("Kill", Console, "`Kill` is a script command of the console; in C write `PauseThread(thread)`"),
    lead_word("Enabled", Console, "`Enabled` is a script command of the console; in C write `ch0->Enable`"),
    lead_word(
        "CheckThread",
        Console,
        "`CheckThread` is a script command of the console; in C let the other thread set an element of `persist.UserData`",
    ),
    lead_word(
        "SetPersistDec",
        Console,
        "`SetPersistDec` is a script command of the console; in C write `persist.UserData[10] = 5`",
    ),
    lead_word(
        "GetPersistDec",
        Console,
        "`GetPersistDec` is a script command of the console; in C write `persist.UserData[10]`",
    ),
    lead_word(
        "SetStartupThread",
        Console,
        "`SetStartupThread` is a script command of the console; in C write `persist.RunOnStartUp |= 1 << thread`",
    ),
    lead_word("Flash", Console, "`Flash` is a script command of the console; a program cannot send it"),
    lead_word("ExecBuf", Console, "`ExecBuf` is a script command of the console; a path comes from the PC"),
    lead_word("OpenBuf", Console, "`OpenBuf` is a script command of the console; a path comes from the PC"),
    lead_word("Linear", Console, "`Linear` is a script command of the console; a path comes from the PC"),
    lead_word("Arc", Console, "`Arc` is a script command of the console; a path comes from the PC"),
    lead_word("PI", Computer, "write `#define PI 3.14159265358979`"),
    lead_word("M_PI", Computer, "write `#define M_PI 3.14159265358979`"),
];

/// Words that are used like types, and what to write instead.
pub const TYPES: &[(&str, &str)] = &[
    ("bool", "use `BOOL` of `KMotionDef.h` with `TRUE` and `FALSE`, or include <stdbool.h>"),
    ("boolean", "use `BOOL` of `KMotionDef.h` with `TRUE` and `FALSE`"),
    ("string", "C has no strings but arrays of `char`, such as `char text[80];`"),
    ("String", "C has no strings but arrays of `char`, such as `char text[80];`"),
    ("byte", "write `unsigned char`"),
    ("word", "write `unsigned short`"),
    ("real", "write `double`"),
    ("integer", "write `int`"),
    ("var", "write the type, such as `int` or `double`"),
    ("let", "write the type, such as `int` or `double`"),
    ("Dim", "write the type, such as `int` or `double`"),
    ("dim", "write the type, such as `int` or `double`"),
    ("function", "a function begins with the type of its result, or `void`"),
    ("def", "a function begins with the type of its result, or `void`"),
    ("sub", "a function begins with the type of its result, or `void`"),
    ("Sub", "a function begins with the type of its result, or `void`"),
    ("uint8_t", "include <stdint.h>"),
    ("int8_t", "include <stdint.h>"),
    ("uint16_t", "include <stdint.h>"),
    ("int16_t", "include <stdint.h>"),
    ("uint32_t", "include <stdint.h>"),
    ("int32_t", "include <stdint.h>"),
    ("uint64_t", "include <stdint.h>"),
    ("int64_t", "include <stdint.h>"),
];

/// Reports whether a word looks like G-code: a letter and a number.
#[must_use]
pub fn is_g_code(word: &str) -> bool {
    const LETTERS: &str = "ABCDFGHIJKLMNPQRSTXYZ";
    let mut characters = word.chars();
    let is_letter = characters.next().is_some_and(|first| LETTERS.contains(first.to_ascii_uppercase()));
    is_letter && word.len() > 1 && characters.all(|character| character.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_is_listed_once() {
        let mut words: Vec<_> = WORDS.iter().map(|word| word.spelling).collect();
        words.extend(TYPES.iter().map(|(word, _)| word));
        let count = words.len();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), count);
    }

    #[test]
    fn the_advice_names_functions_that_the_firmware_has() {
        for name in ["Delay_sec", "Time_sec", "SetStateBit", "SetBitDirection", "printf"] {
            assert!(kmotiondef::firmware::function_named(name).is_some(), "{name}");
        }
    }

    #[test]
    fn g_code_is_letters_with_numbers() {
        assert!(["G0", "x10", "M3", "S1000"].iter().all(|word| is_g_code(word)));
        assert!(["G", "ch0", "i2", "E", "G0X"].iter().filter(|word| is_g_code(word)).eq(["i2"].iter()));
    }
}
