//! Conversions, pointer arithmetic, places and operators.

use super::{expression, said};

#[test]
fn operands_are_converted_to_their_common_type() {
    expression("gi = i + c", "@gi = (i + (int)[c])");
    expression("gi = i + u", "@gi = (int)[((unsigned int)[i] + u)]");
    expression("gd = i * d", "@gd = ((double)[i] * d)");
    expression("gd = f + f", "@gd = (double)[(f + f)]");
    expression("gd = f * 2", "@gd = (double)[(f * 2.0f)]");
    expression("gd = f * 2.0", "@gd = ((double)[f] * 2.0)");
    expression("gi = l > i", "@gi = (l > (long long)[i])");
    expression("gi = c << u", "@gi = ((int)[c] << (int)[u])");
    expression("gi = u < i", "@gi = (u < (unsigned int)[i])");
    expression("gi = -c", "@gi = -(int)[c]");
    expression("gi = !d", "@gi = !d");
    expression("gi = ~(c ^ 1)", "@gi = ~((int)[c] ^ 1)");
    expression("gi = d && !p || i", "@gi = ((d && !p) || i)");
    expression("gd = i ? i : d", "@gd = (i ? (double)[i] : d)");
    expression("gi = i ?: 3", "@gi = (t9 = i, (t9 ? t9 : 3))");
    expression("gi = (_Bool)d", "@gi = (int)[(_Bool)[(d != 0.0)]]");
    expression("gi = sizeof(i++) + 2 * 3", "@gi = 10");
}

#[test]
fn assignments_convert_and_updates_compute_in_the_common_type() {
    expression("c = i", "c = (char)[i]");
    expression("f = d", "f = (float)[d]");
    expression("gi = c = d", "@gi = (int)[c = (char)[d]]");
    expression("i *= 1.5", "i *= 1.5 in double");
    expression("c += 1", "c += 1 in int");
    expression("c++", "old c += 1 in int");
    expression("--d", "d -= 1.0 in double");
    expression("p++", "old p += 4 in int *");
    expression("p -= i", "p -= (i * 4) in int *");
    expression("q += 2", "q += 16 in double *");
    expression("u >>= c", "u >>= (int)[c] in unsigned int");
    expression("f /= 3", "f /= 3.0f in float");
    expression("gs.u |= 3", "@gs{20:unsigned int}<19+5> |= 3:unsigned int in unsigned int");
}

#[test]
fn pointer_arithmetic_is_scaled_to_bytes() {
    expression("gi = *p", "@gi = *p");
    expression("gi = p[3]", "@gi = *p{12:int}");
    expression("gi = 3[p]", "@gi = *p{12:int}");
    expression("gi = p[i]", "@gi = *(p + (i * 4))");
    expression("gi = *(p + i - 1)", "@gi = *(p + (i * 4)){-4:int}");
    expression("gi = ga[3]", "@gi = @ga{12:int}");
    expression("gi = ga[i]", "@gi = *(&@ga + (i * 4))");
    expression("gi = s[i]", "@gi = (int)[*(s + i)]");
    expression("gi = &ga[5] - ga", "@gi = (((int)[&@ga{20:int}] - (int)[&@ga]) / 4)");
    expression("gi = q - &gd", "@gi = (((int)[q] - (int)[&@gd]) / 8)");
    expression("gd = *(float *)&ga[2]", "@gd = (double)[@ga{8:float}]");
    expression("gi = ((int *)&gd)[1]", "@gi = @gd{4:int}");
    expression("gi = *(char *)0x91000000", "@gi = (int)[*2432696320:char *]");
    expression("p = (int *)i + 1", "p = ((int *)[i] + 4)");
    expression("gi = p == 0 || !s", "@gi = ((p == 0:int *) || !s)");
}

#[test]
fn members_are_offsets() {
    expression("gi = gs.a", "@gi = @gs{0:int}");
    expression("gd = gp->b", "@gd = *@gp{8:double}");
    expression("gi = gp->c[2]", "@gi = (int)[*@gp{20:short}]");
    expression("gi = (*gp).c[i]", "@gi = (int)[*((short *)[(@gp + 16)] + (i * 2))]");
    expression("gi = gs.f + gs.u", "@gi = (@gs{20:int}<16+3> + (int)[@gs{20:unsigned int}<19+5>])");
    expression("p = &gp->a", "p = (int *)[@gp]");
    expression("q = &gp[1].b", "q = (double *)[(@gp + 32)]");
    expression("gs = *gp", "(copy @gs <- *@gp, &@gs)");
}

#[test]
fn structures_are_copied() {
    expression("struct S x = gs; gs = x", "copy x <- @gs;\n  (copy @gs <- x, &@gs)");
}

#[test]
fn a_function_that_is_not_called_is_no_operand() {
    said(
        "double now(void);\nint g(double start) {\n return now - start > 5;\n}",
        &[
            "3: error: `-` cannot be used on `double (*)(void)` and `double` (this is the function itself: call it with `()` after its name)",
        ],
    );
}

#[test]
fn wrong_operands_are_errors() {
    said(
        "struct S { int a; } s; int *p, *r; double d; void f(void);\nint g(int i) {\n d % 2.0;\n p + r;\n p * 2;\n ~d;\n s + 1;\n *i;\n i[i];\n s->a;\n p.a;\n s.b;\n i();\n &3;\n 3 = i;\n f = 0;\n p = d;\n d = p;\n (double)p;\n s = i;\n return s;\n}",
        &[
            "3: error: `%` cannot be used on `double` and `double` (convert the value first: `(int)(…)`)",
            "4: error: `+` cannot be used on `int *` and `int *`",
            "5: error: `*` cannot be used on `int *` and `int`",
            "6: error: `~` needs an integer",
            "7: error: `struct S` is used where a number or pointer is needed (write a member of it, after a `.`)",
            "8: error: `*` needs a pointer, but this is `int`",
            "9: error: `int` cannot be indexed",
            "10: error: `->` needs a pointer, but this is a `struct S` (use `.a`)",
            "11: error: `.a` needs a structure, but this is `int *`",
            "12: error: `struct S` has no member `b`",
            "13: error: `int` cannot be called",
            "14: error: `&` needs a variable: a value has no address",
            "15: error: a value cannot be assigned to",
            "16: error: a function cannot be assigned to",
            "17: error: assignment: cannot convert `double` to `int *` (write `*` before the pointer to store in what it points to)",
            "18: error: assignment: cannot convert `int *` to `double` (write `*` before it for the value it points to)",
            "19: error: cannot cast `int *` to `double`",
            "20: error: assignment: cannot convert `int` to `struct S`",
            "21: error: `struct S` is used where a number or pointer is needed (write a member of it, after a `.`)",
        ],
    );
}

#[test]
fn one_mistake_is_reported_once() {
    said(
        "int f(int i) { return (x + 1) * x[3] + i.y->z + x; }\nint g(void) { return x; }",
        &[
            "1: error: `x` is not declared",
            "1: error: `.y` needs a structure, but this is `int`",
            "2: error: `x` is not declared",
        ],
    );
}
