//! The condition of the loop that a line of C belongs to, as its text.
//!
//! This is for a person who reads what a thread waits for. It goes by the text alone: what it does not find, it does not
//! show.

use kmotiondef::variables::variable_named;

/// The number of lines before an address in which its loop may begin.
const LINES: usize = 8;
/// Most characters of a condition that is shown.
const LONGEST: usize = 60;

/// The condition of a `while` or of `do … while`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct WaitCondition(String);

impl WaitCondition {
    /// The condition of the innermost `while` that begins at a line, counted from 1, or shortly before it.
    pub(super) fn around(text: &str, line: u32) -> Option<Self> {
        let lines: Vec<&str> = text.lines().collect();
        let last = usize::try_from(line).ok()?.checked_sub(1)?;
        let first = last.saturating_sub(LINES);
        (first..=last).rev().find_map(|at| {
            let begin = find_word(lines.get(at)?, "while")? + "while".len();
            let rest = lines.get(at..)?.join(" ").get(begin..)?.trim_start().to_owned();
            let inside = parenthesized_text(&rest)?;
            let words = inside.split_whitespace().collect::<Vec<_>>().join(" ");
            let is_shown = words.chars().count() <= LONGEST && !is_endless(&words);
            is_shown.then_some(Self(words))
        })
    }

    /// Reports whether the loop that begins at a line, counted from 1, or shortly before it has no end.
    pub(super) fn is_endless_at(text: &str, line: u32) -> bool {
        let lines: Vec<&str> = text.lines().collect();
        let Some(last) = usize::try_from(line).ok().and_then(|line| line.checked_sub(1)) else {
            return false;
        };
        let first = last.saturating_sub(LINES);
        let head = |at: usize, word: &str| {
            let begin = find_word(lines.get(at)?, word)? + word.len();
            let rest = lines.get(at..)?.join(" ").get(begin..)?.trim_start().to_owned();
            parenthesized_text(&rest).map(|inside| inside.split_whitespace().collect::<String>())
        };
        let endless = (first..=last).rev().find_map(|at| {
            let of_while = head(at, "while").map(|condition| is_endless(&condition));
            of_while.or_else(|| head(at, "for").map(|parts| parts.split(';').nth(1) == Some("")))
        });
        endless == Some(true)
    }

    /// Returns the text between the parentheses.
    pub(super) fn text(&self) -> &str {
        &self.0
    }

    /// The first variable in it, with its members and indexes; nothing if a function is called.
    pub(super) fn operand(&self) -> Option<&str> {
        let text = &self.0;
        let begin = text.find(|c: char| c.is_ascii_alphabetic() || c == '_')?;
        let rest = &text[begin..];
        let mut depth = 0_u32;
        let mut ends = |(at, c): (usize, char)| {
            let is_inside = depth > 0;
            match c {
                '[' => depth += 1,
                ']' => depth = depth.saturating_sub(1),
                _ => {}
            }
            let before = rest[..at].chars().next_back();
            let is_arrow = c == '-' && rest[at..].starts_with("->") || c == '>' && before == Some('-');
            !(is_inside || "[._".contains(c) || c.is_ascii_alphanumeric() || is_arrow)
        };
        let end = rest.char_indices().find(|&it| ends(it)).map_or(rest.len(), |(at, _)| at);
        let is_call = rest[end..].trim_start().starts_with('(');
        (!is_call && !text.contains('(')).then_some(&rest[..end])
    }

    /// The right side of its comparison, if that is all it has and computes something.
    pub(super) fn right_side(&self) -> Option<&str> {
        let text = &self.0;
        if ["&&", "||", "(", "->"].iter().any(|other| text.contains(other)) {
            return None;
        }
        let (left, right) = text.split_once(['<', '>', '=', '!'])?;
        let right = right.trim_start_matches('=').trim();
        let is_plain = right.parse::<f64>().is_ok() || right.contains(['<', '>', '=', '!']);
        (!left.is_empty() && !is_plain).then_some(right)
    }

    /// The line, from 1, of the first store in a variable that is written exactly so.
    pub(super) fn stored_at(text: &str, name: &str) -> Option<u32> {
        let compact = |text: &str| text.split_whitespace().collect::<String>();
        let name = compact(name);
        let is_store = |line: &str| {
            let line = compact(line.split("//").next().unwrap_or_default());
            line.match_indices(&name).any(|(at, _)| {
                let after = &line[at + name.len()..];
                after.starts_with('=') && !after.starts_with("==")
            })
        };
        (1..).zip(text.lines()).find(|(_, line)| is_store(line)).map(|(number, _)| number)
    }

    /// Returns whether a text stores to a variable, or passes its address on.
    pub(super) fn writes(text: &str, name: &str) -> bool {
        let base = name.split(['[', '.', '-']).next().unwrap_or(name);
        // What the firmware or the PC changes.
        if variable_named(base).is_some() {
            return true;
        }
        let mut from = 0;
        while let Some(at) = find_word(&text[from..], base).map(|at| at + from) {
            from = at + base.len();
            let (before, after) = (text[..at].trim_end(), after_index(text[from..].trim_start()));
            let is_stored = after.starts_with('=') && !after.starts_with("==")
                || after.starts_with("++")
                || after.starts_with("--")
                || (after.get(1..2) == Some("=")
                    && after.starts_with(['+', '-', '*', '/', '|', '&', '^', '%']))
                || after.starts_with("<<=")
                || after.starts_with(">>=");
            let is_declared = before.ends_with(|c: char| c.is_ascii_alphanumeric());
            if is_stored && !is_declared || before.ends_with("++") || before.ends_with("--") {
                return true;
            }
            if before.ends_with('&') && !before.ends_with("&&") {
                return true;
            }
            // The macro may stand for anything.
            if before.ends_with("define") {
                return true;
            }
        }
        false
    }
}

/// Returns the text after an index, if there is one: a member or nothing.
fn after_index(text: &str) -> &str {
    match text.strip_prefix('[') {
        Some(rest) => rest.split_once(']').map_or("", |(_, after)| after_index(after.trim_start())),
        None => text,
    }
}

/// Returns whether a condition is always true, as in `while (1)`.
fn is_endless(text: &str) -> bool {
    matches!(text, "1" | "TRUE" | "true" | "")
}

/// Returns the offset of a word in a text, where it is not a part of a longer one.
fn find_word(text: &str, word: &str) -> Option<usize> {
    let is_letter = |c: Option<char>| c.is_some_and(|c| c.is_ascii_alphanumeric() || c == '_');
    let mut from = 0;
    while let Some(at) = text.get(from..)?.find(word).map(|at| at + from) {
        let end = at + word.len();
        if !is_letter(text[..at].chars().next_back()) && !is_letter(text[end..].chars().next()) {
            return Some(at);
        }
        from = end;
    }
    None
}

/// Returns the text between the parenthesis at the beginning and the one that closes it.
fn parenthesized_text(text: &str) -> Option<&str> {
    let mut depth = 0_u32;
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' if depth == 1 => return text.get(1..at),
            ')' => depth = depth.checked_sub(1)?,
            _ if depth == 0 => return None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, line: u32, expect: Option<(&str, Option<&str>)>) {
        let condition = WaitCondition::around(text, line);
        let found = condition.as_ref().map(|condition| (condition.text(), condition.operand()));
        assert_eq!(found, expect, "{text}");
    }

    #[test]
    fn the_condition_is_that_of_the_innermost_loop() {
        check("while (!flag) WaitNextTimeSlice();", 1, Some(("!flag", Some("flag"))));
        check("while (a[i] == 3)\n  ;", 2, Some(("a[i] == 3", Some("a[i]"))));
        check(
            "while (persist.UserData[5]\n  == 0)\n{\n  x();\n}",
            4,
            Some(("persist.UserData[5] == 0", Some("persist.UserData[5]"))),
        );
        check("while (ch0->Dest < 5) ;", 1, Some(("ch0->Dest < 5", Some("ch0->Dest"))));
        check("while (!CheckDone(0)) ;", 1, Some(("!CheckDone(0)", None)));
        check("while (1)\n  x++;", 2, None);
        check("x++;", 1, None);
    }

    #[test]
    fn the_right_side_of_a_comparison_is_shown_where_it_computes() {
        for (text, expect) in [
            ("Spindle.TrueSpeedRPS < 0.95 * RPM", Some("0.95 * RPM")),
            ("a >= b", Some("b")),
            ("a != 3", None),
            ("!a", None),
            ("a < b && c < d", None),
            ("a", None),
        ] {
            assert_eq!(WaitCondition(text.to_owned()).right_side(), expect, "{text}");
        }
    }

    #[test]
    fn the_line_of_a_store_is_found() {
        let text = "while (!persist.UserData[ READY ]) ;\n// persist.UserData[READY] = 2;\nif (persist.UserData[READY] == 1)\n  persist.UserData[READY] = 1;\n";
        assert_eq!(WaitCondition::stored_at(text, "persist.UserData[READY]"), Some(4));
        assert_eq!(WaitCondition::stored_at(text, "persist.UserData[DONE]"), None);
    }

    #[test]
    fn stores_are_found_in_the_text() {
        for (text, expect) in [
            ("int flag;\nmain() { while (!flag) ; }", false),
            ("int flag = 0;\nmain() { while (flag == 0) ; }", false),
            ("void f() { flag = 1; }", true),
            ("void f() { flag++; }", true),
            ("void f() { g(&flag); }", true),
            ("void f() { a && flag; }", false),
            ("void f() { flags = 1; }", false),
            ("void f() { flag |= 4; }", true),
        ] {
            assert_eq!(WaitCondition::writes(text, "flag"), expect, "{text}");
        }
        assert!(WaitCondition::writes("", "persist.UserData[5]"));
    }
}
