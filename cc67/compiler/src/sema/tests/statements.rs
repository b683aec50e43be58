//! Statements.

use super::{check, said};

#[test]
fn control_flow() {
    check(
        "int f(int i, double d) { while (d) f(i, d); do i--; while (i > 3); for (int k = 0; k < i; k++) { if (k == 5) break; else continue; } for (;;) goto out; out: return i; }",
        "int f(int i, double d) {
          while d {
            f(i, d);
          }
          do {
            old i -= 1 in int;
          } while (i > 3)
          {
            k = 0;
            while (k < i); old k += 1 in int {
              if (k == 5) {
                break;
              } else {
                continue;
              }
            }
          }
          {
            while true {
              goto out;
            }
          }
          out:
          return i;
        }",
    );
}

#[test]
fn switches_number_their_cases() {
    check(
        "int f(char c) { switch (c) { case 'a': case 3 ... 5: return 1; default: break; case -1:; } return 0; }",
        "int f(char c) {
          switch (int)[c] [97, 3...5, -1; default] {
            {
              case #0:
              case #1:
              return 1;
              default:
              break;
              case #2:
            }
          }
          return 0;
        }",
    );
    said(
        "void f(int i, double d) { switch (i) { case 1: case 2: case 1: break; case 1 ... 3: break; case 9 ... 8:; default:; default:; case d:; }\nswitch (d) { case 1: break; } case 4: break; continue; default: goto nowhere; a:; a:; }",
        &[
            "1: error: this range of cases is empty",
            "1: error: a second `default` in one `switch`",
            "1: error: the value of a `case` must be an integer constant (name the number by `#define`, or use `if`)",
            "1: error: `case 1` appears twice in one `switch`",
            "1: error: `case 1` appears twice in one `switch`",
            "1: error: `case 2` appears twice in one `switch`",
            "2: extension: `switch` on a floating-point value (write `(int)` if this is meant)",
            "2: error: `case` outside a `switch` (is there an extra `}` before it?)",
            "2: error: `continue` outside a loop",
            "2: error: `default` outside a `switch`",
            "2: error: label `a` is defined twice",
            "2: error: label `nowhere` is used but not defined",
        ],
    );
}

#[test]
fn variable_arguments_are_read_from_memory() {
    check(
        "double f(int n, ...) { va_list l; double s = 0; va_start(l, n); while (n--) s += va_arg(l, double); va_arg(l, float); va_end(l); return s; }",
        "double f(int n) {
          s = 0.0;
          (void)[l = t1];
          while old n -= 1 in int {
            s += va_arg(l, double) in double;
          }
          (float)[va_arg(l, double)];
          (void)[0];
          return s;
        }",
    );
}

#[test]
fn statement_expressions_have_a_value() {
    check(
        "int f(int i) { return ({ int k = i; k + 1; }); }",
        "int f(int i) {\nreturn ({\nk = i;\n(k + 1) });\n}",
    );
}

#[test]
fn long_sums_do_not_count_as_nesting() {
    let sum = vec!["i"; 3_000].join("+");
    let (_, _, said) = super::analyzed(&format!("int f(int i) {{ return {sum}; }}"));
    assert_eq!(said, [""; 0]);
}
