//! Round trips: printed IR is read back; malformed IR is rejected with its line.

use super::super::text;
use super::*;

/// Reads a text and prints it again.
fn reprint(source: &str) -> Result<String, ParseError> {
    let unit = parse(source)?;
    Ok(unit.functions.iter().map(|function| text::print(function, &unit.signatures, &unit.symbols)).collect())
}

#[track_caller]
fn check_same(source: &str) {
    assert_eq!(reprint(source).as_deref(), Ok(source));
}

#[track_caller]
fn check_error(source: &str, expected: &str) {
    let error = reprint(source).expect_err("it is wrong");
    assert_eq!(error.to_string(), expected, "{source}");
}

#[test]
fn every_kind_of_line_is_read_back() {
    check_same(
        "\
function all(v0: i32, v1: f64) -> i64
  slot0: 16 bytes, align 8
  slot1: 3 bytes, align 1
  v9: f32
block0:
  v2 = v0
  v2 = -7
  v3 = -9223372036854775808L
  v4 = &table - 12
  v5 = neg.f64 v1
  v6 = not.i64 v3
  v7 = shl.i64 v6, v0
  v8 = le.f32 v9, 0.1f
  v10 = i64_from_f64_u -1e300
  v11 = load.u16 [v4 + 2]
  v12 = load.f64 [0x91000000]
  store.i8 v11, [@slot1 - 4]
  store.f64 v12, [slot1]
  v13 = address [slot0 + 8]
  copy_memory [v13], [L.3 + 4], 16
  clear_memory [slot0], 16
  v14 = call.i64 f(v0, 1L, 1.0f, 1.0, &@v0)
  call.i64 [v4](-0.0)
  call [&g]()
  table v0, [block2, block3], block5
block2:
  jump block2
block3:
  branch v8, block2, block5
block5:
  return v14
",
    );
    check_same(
        "function @v1()\nblock7:\n  return\nfunction g()\nblock0:\n  table 1, [], block1\nblock1:\n  unreachable\n",
    );
}

#[test]
fn constants_keep_their_bits() {
    check_same(
        "\
function f() -> f64
block0:
  v0 = 1e-45f
  v1 = f32(0x7fc00001)
  v2 = f64(0xfff8000000000000)
  v3 = f64(0x7ff0000000000000)
  v4 = 5e-324
  v5 = 2147483647
  return v4
",
    );
}

#[test]
fn copies_take_their_sources_class_and_unwritten_values_are_declared() {
    check_same(
        "function f(v0: f32) -> f32\nblock0:\n  jump block1\nblock1:\n  v1 = v2\n  v2 = v0\n  branch 1, block1, block2\nblock2:\n  return v1\n",
    );
    check_same("function f() -> i64\n  v0: i64\n  v1: i64\nblock0:\n  v0 = v1\n  v1 = v0\n  return v0\n");
    // A redundant declaration is not printed.
    assert_eq!(
        reprint("function f()\n  v0: i32\nblock0: ; entry\n\n  v0 = 1\n  return\n").as_deref(),
        Ok("function f()\nblock0:\n  v0 = 1\n  return\n")
    );
}

#[test]
fn errors_name_the_line_and_the_cause() {
    let in_block = |line: &str| format!("function f(v0: i32)\nblock0:\n  {line}\n  return\n");
    for (line, expected) in [
        ("v1 = add.i32 v0", "`,` is expected at the end"),
        ("v1 = add v0, 1", "a class is expected after the `.`, not ``"),
        ("v1 = add.f16 v0, 1", "a class is expected after the `.`, not `f16`"),
        ("v1 = load.i24 [v0]", "a width is expected after the `.`, not `i24`"),
        ("v1 = load.i32 v0", "`[` is expected before `v0`"),
        ("v1 = mumble.i32 v0", "`mumble.i32` is not an operand"),
        ("mumble v0", "there is no instruction `mumble`"),
        ("v1 = 99999999999", "`99999999999` is not an operand"),
        ("v9999999 = 1", "the number of `v9999999` is too large"),
        ("v1 = &a + 4294967295", "4294967295 is out of range"),
        ("v1 = address [g]", "`address` takes a slot"),
        ("v1 = f32(0x1ffffffff)", "`0x1ffffffff` is not the bits of an f32"),
        ("store.i32 1, [v0] twice", "the end of the line is expected before `twice`"),
        ("store.i32 v5, [v0]", "nothing says the class of v5: declare it before the first block"),
        ("v0 = 1L", "v0 is i32 elsewhere, i64 here"),
        ("v1 = add.i32 1L, v0", "Constant(I64(1)) is i64, i32 expected"),
        ("v1 = and.f64 1.0, 2.0", "no such operator on the class"),
        ("v1 = lt.i64 v0, v0", "Value(v0) is i32, not i64"),
        ("slot0: 4 bytes, align 4", "`slot0` is declared after the first block"),
        ("block0:", "block0 does not end before this"),
        ("store.i32 1, [slot0]", "no such slot"),
    ] {
        check_error(&in_block(line), &format!("line 3: {expected}"));
    }
    check_error("function f()\nblock0:\n  jump block7\n", "line 3: there is no block7");
    check_error("function f()\nblock0:\n  return 1\n", "line 3: class of the result");
    check_error("v0 = 1\n", "line 1: a function begins with `function name(…)`");
    check_error("function f()\n", "line 1: the function has no block");
    check_error("function f()\nblock0:\n", "line 2: block0 does not end");
    check_error("function f()\n  slot1: 4 bytes, align 4\n", "line 2: slot0 comes next, not slot1");
    check_error("function f()\nblock0:\n  return\n  return\n", "line 4: this is not in a block");
    check_error("function f()\nblock0:\n  return\nblock0:\n  return\n", "line 4: block0 appears twice");
}
