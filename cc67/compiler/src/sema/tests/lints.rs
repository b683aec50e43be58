//! Warnings: programs that cause them, and programs that do not.

use super::{accept, said};

const PERSIST: &str = "typedef struct { int Head[8]; int UserData[200]; } PERSIST; extern PERSIST persist;";

#[test]
fn pointers_and_integers() {
    said(
        "int *p, i; char **pp; struct A { int a; } *a; struct B *b;\nvoid f(void) {\np = 5;\ni = p;\np = 0;\npp = &p;\na = b;\nif (p == 3) i = p == 0;\n}",
        &[
            "3: int-pointer: assignment makes a pointer from an integer without a cast (write `(int *)` if this is meant)",
            "4: int-pointer: assignment makes an integer from a pointer without a cast (write `(int)` if this is meant)",
            "6: pointer-mismatch: assignment makes a pointer to another type without a cast (write `(char **)` if this is meant)",
            "7: error: assignment: cannot convert `struct B *` to `struct A *`",
            "8: int-pointer: a pointer is mixed with an integer without a cast",
        ],
    );
    accept(
        "int *p; unsigned *u; char *c; void *v; volatile int *w; double *d; void f(void) { p = u; v = p; c = p; p = v; p = w; d = c; w = p; d = (double *)p; }",
    );
    said(
        "int *p; double *d; void f(void) { d = p; }",
        &[
            "1: pointer-mismatch: assignment makes a pointer to another type without a cast (write `(double *)` if this is meant)",
        ],
    );
}

#[test]
fn persist_user_data() {
    let with = |rest: &str| format!("{PERSIST}\n{rest}");
    accept(&with(
        "float *f = &persist.UserData[5]; double *d = &persist.UserData[6]; void g(void) { f = &persist.UserData[7]; persist.UserData[199] = 1; *(double *)&persist.UserData[4] = 1; }",
    ));
    said(
        &with("void g(int i) { persist.UserData[200] = 1; persist.UserData[-1] = i; }"),
        &[
            "2: user-data-index: `persist.UserData` has no element 200",
            "2: user-data-index: `persist.UserData` has no element -1",
        ],
    );
    said(
        &with("void g(void) { *(double *)&persist.UserData[5] = 1; }"),
        &[
            "2: user-data-alignment: a `double` at an odd index of `persist.UserData` is not aligned (use index 4 or 6)",
        ],
    );
}

#[test]
fn conditions_and_statements() {
    said(
        "int f(int a, int b) {\nif (a = b) a++;\nwhile ((a = b)) b--;\ndo a++; while (a = b-- > 0);\na == b;\nf;\na + 1;\nif (a) ;\nif (b)\n;\nwhile (a--) ;\nreturn a;\n}",
        &[
            "2: assignment-condition: an assignment is used as a condition (write `==` to compare, or a second pair of parentheses if this is meant)",
            "4: assignment-condition: an assignment is used as a condition (write `==` to compare, or a second pair of parentheses if this is meant)",
            "5: unused-value: this statement has no effect (`=` assigns, `==` compares)",
            "6: unused-value: this statement has no effect (write `()` after the name to call the function)",
            "7: unused-value: this statement has no effect",
            "8: empty-body: `if` with an empty body (remove the `;`, or write `{}` if nothing should be done)",
        ],
    );
    accept(
        "volatile int *r; int g(void); void f(int a, int *p) { *r; (void)a; a && g(); a ? g() : 0; p++; a++, g(); }",
    );
}

#[test]
fn numbers() {
    said(
        "const int n = 1; int f(double d, float x, int i) { n = 2; return (d != d) + (i == i) + (1 << 40) + (i >> -1); }",
        &[
            "1: const-write: a `const` object is modified",
            "1: shift-count: a shift by 40",
            "1: shift-count: a shift by -1",
            "1: self-comparison: a floating-point value is compared with itself",
        ],
    );
    said(
        "int a[3]; int f(double d) { return a[d]; }",
        &["1: extension: an index of type `double` (write `(int)` if this is meant)"],
    );
    accept("long long f(long long a) { return a << 40; }");
}

#[test]
fn formats() {
    said(
        "int printf(const char *, ...); void f(double d, int *p) { printf(\"%d\\n\", d); printf(\"%f %s\", d, \"x\"); printf(\"%d\\n\"); }",
        &["1: format: `%d` needs an `int` (use `%f`)", "1: format: there is no argument for `%d`"],
    );
}

#[test]
fn locals_without_a_value() {
    said(
        "int g(int *); int f(int c) {\nint a, b, d, e = 1, h, k[2], m;\nif (c) b = 1;\nwhile (c--) { e += d; d = e; }\ndo { int z; h = z; z = c; } while (c++ < 3);\ng(&h);\nreturn a + b + h + k[0] + c + m;\n}",
        &[
            "7: uninitialized: `a` is read before it has a value",
            "4: uninitialized: `d` is read before it has a value",
            "7: uninitialized: `m` is read before it has a value",
            "5: uninitialized: `z` is read before it has a value",
        ],
    );
}

#[test]
fn loops_without_an_end() {
    said(
        "main() { for (;;) ; }",
        &[
            "1: idle-loop: this loop does nothing and never ends (end the program by returning from `main`, or call `WaitNextTimeSlice()` in the loop)",
        ],
    );
    accept(
        "volatile int x; void w(void); void f(void) { for (;;) w(); } void g(int i) { for (;;) { if (i) break; } while (x) ; for (;;) x = 1; }",
    );
}

#[test]
fn redefined_firmware_names() {
    said(
        "int ReadBit(int bit) { return bit; } static double sqrt(double x) { return x; } int f(void) { return sqrt(ReadBit(1)); }",
        &["1: redeclared: the firmware already has a `ReadBit` (choose another name, or make it `static`)"],
    );
}

#[test]
fn indentation_that_misleads() {
    said(
        "void g(void); void f(int i) {\n  if (i)\n    i++;\n    g();\n  for (; i; i--)\n    g();\n  g();\n  if (i) i = 1;\n  else\n\ti = 2;\n\tg();\n  while (i) {\n    i--; }\n    g();\n}",
        &[
            "4: misleading-indentation: this statement is always executed (put both in braces, or move this one to the left)",
        ],
    );
}

#[test]
fn out_of_bounds_elements() {
    said(
        "int a[3], m[2][2], i; char t[4]; struct { int n[2], end; } s[2]; void f(void) {\nint l[3], j; a[3] = a[-1]; l[3] = 0; l[j = 0] = 1;\nm[2][0] = m[1][2]; m[0][3]++; s[2].end = s[1].n[2];\nfor (j = 0; j <= 3; j++) a[j] = 0;\nfor (j = 1; j < 4; j += 2) t[j + 1] = t[j - 1];\nfor (j = 0; j < 2; j++) { if (a[j + 2]) i++; }\n*(a + 4) = *(int *)(t + 2);\n}",
        &[
            "2: array-bounds: `a` has no element -1",
            "2: array-bounds: `a` has no element 3",
            "2: array-bounds: `l` has no element 3",
            "3: array-bounds: `m` has no element 2",
            "3: array-bounds: `m` has no element 2",
            "3: array-bounds: `s` has no element 2",
            "7: array-bounds: `t` has no element 4",
            "7: array-bounds: `a` has no element 4",
            "4: array-bounds: `a` has no element 3",
            "5: array-bounds: `t` has no element 4",
            "6: array-bounds: `a` has no element 3",
        ],
    );
    accept(
        "int a[3], n; extern int e[]; char t[4]; int *p = a + 3; void g(int *); struct { int n[2], end; } s;
         void f(int i) { int j; a[2] = e[9]; s.n[2] = 0; p = &a[3]; n = &a[3] - a + sizeof a[3]; *(int *)t = 0; g(a + 3);
         for (j = 0; j < 3; j++) a[j] = 0; for (j = 0; j <= 3; j++) { if (j == 3) break; a[j] = 0; }
         for (j = 0; j <= 3; j++) if (j < 3) a[j] = 0; for (j = 0; j <= 3; j++) { a[j] = 0; j++; }
         for (j = 0; j <= 3; j++) n += j < 3 && a[j]; for (j = 0; j <= n; j++) a[j] = 0; for (j = 3; j < 3; j++) a[j] = 0;
         for (j = 0; j <= 3; j++) n += j < 3 ? a[j] : 0; for (j = 0; j <= 3; j++) a[i] = 0; }
         struct P { int x, y; } q[3]; void (*h[3])(void); struct { unsigned on : 1; } b[3];
         void k(struct P z) { int j; for (j = 0; j <= 3; j++) { q[j].x = 1; q[j++] = z; }
         for (j = 0; j <= 3; j++) { a[j] = 0; h[j++](); } for (j = 0; j <= 3; j++) { a[j] = 0; b[j++].on = 1; } }",
    );
}

#[test]
fn call_backs_must_not_wait() {
    said(
        "extern void (*UserCallBack)(void); void WaitNextTimeSlice(void); int n;\nvoid good(void) { n++; } void bad(void) { WaitNextTimeSlice(); } main() { UserCallBack = good; UserCallBack = bad; WaitNextTimeSlice(); }",
        &[
            "2: call-back-wait: `WaitNextTimeSlice` in the call-back may wait (set a variable here, and call the function in a thread that checks the variable)",
        ],
    );
}
