"""Shapes of programs, each of a size: one kind of thing many times, as generators of code write it."""


def whole(body, before="", declarations=""):
    """A program of a function."""
    return f"{before}\nint a, b, c;\ndouble x;\n\nint main(void)\n{{\n{declarations}{body}\n    return a;\n}}\n"


def lines(count, line):
    """A line for each number."""
    return "\n".join(line(n) for n in range(count))


def statements(n):
    """Assignments, one after another."""
    return whole(lines(n, lambda k: f"    a = b * {k} + c;"))


def terms(n):
    """One sum of integers."""
    return whole("    a = " + " + ".join(f"b * {k}" for k in range(n)) + ";")


def doubles(n):
    """One sum of doubles."""
    return whole("    x = " + " + ".join(f"x * {k}.5" for k in range(n)) + ";")


def labels(n):
    """Labels, each with a jump to another one."""
    return whole(lines(n, lambda k: f"l{k}:\n    if (a++ == {k})\n        goto l{(k * 7 + 3) % n};"))


def nesting(n):
    """Statements in blocks that are nested a hundred deep."""
    return whole(lines(max(n // 100, 1), lambda k: "{ int v = b; " * 100 + f"c += {k} + v;" + " }" * 100))


def locals_of_main(n):
    """Local variables that are all live at the same time."""
    uses = lines(n, lambda k: f"    a += v{k} * v{(k * 5 + 1) % n};")
    return whole(uses, declarations=lines(n, lambda k: f"    int v{k} = b + {k};") + "\n")


def calls(n):
    """Calls of fifty functions, one after another."""
    functions = lines(50, lambda k: f"static int f{k}(int n)\n{{\n    int i, s = 0;\n    for (i = 0; i < n; i++)\n        s += i * {k};\n    return s;\n}}")
    return whole(lines(n, lambda k: f"    a += f{k % 50}(b + {k});"), functions)


def call_chain(n):
    """Functions, each of which calls the one before."""
    return whole(f"    a = f{n - 1}(b);", "int f0(int n) { return n; }\n" + lines(n - 1, lambda k: f"int f{k + 1}(int n) {{ return f{k}(n + {k}) + 1; }}"))


def cases(n):
    """Cases of one switch."""
    return whole("    switch (b) {\n" + lines(n, lambda k: f"    case {k * 3}: a = c + {k}; break;") + "\n    }")


def functions(n):
    """Functions with a loop."""
    before = lines(n, lambda k: f"int g{k}(int n)\n{{\n    int s = 0;\n    while (n-- > 0)\n        s += n * {k};\n    return s;\n}}")
    return whole(lines(n, lambda k: f"    a += g{k}(b);"), before)


def loops(n):
    """Loops, one after another."""
    return whole(lines(n, lambda k: f"    for (c = 0; c < b; c++)\n        a += c * {k};"))


def initialisers(n):
    """Numbers of a table, and its rows."""
    return whole("    a = t[b][1];", "int t[][4] = {" + ", ".join(f"{{{k}, [3] = {k}}}" for k in range(n)) + "};")


def macros(n):
    """Macros, each of which uses another one."""
    defined = lines(n - 1, lambda k: f"#define M{k + 1}(x) (M{k if (k + 1) % 8 else 0}(x) + {k})")
    return whole(lines(n, lambda k: f"    a += M{k}(b);"), "#define M0(x) ((x) + 1)\n" + defined)


def struct_copies(n):
    """Copies of whole structures."""
    return whole(lines(n, lambda k: f"    s[{k % 60}] = s[{(k * 7 + 1) % 60}];"), "struct S { int a, b; double c; } s[60];")


def struct_stores(n):
    """Stores to members of structures, by name and by pointer."""
    members = "".join(f" int m{k};" for k in range(40))
    return whole(lines(n, lambda k: f"    s.m{k % 40} = b + {k}; p->m{k * 3 % 40} = s.m{k * 7 % 40};"), f"struct S {{{members} }} s, *p;")


def pointer_chains(n):
    """Steps along a list."""
    return whole(lines(n, lambda _: "    p = p->next; a += p->v;"), "struct N { struct N *next; int v; } h;", "    struct N *p = &h;\n")


def strings(n):
    """Texts, each a different one."""
    return whole(lines(n, lambda k: f'    q = "text {k}";'), "char *q;")


# The size of each shape at an eighth of its most; a build takes some hundredths of a second then.
SHAPES = {
    statements: 1000,
    terms: 1000,
    doubles: 500,
    labels: 500,
    nesting: 2000,
    locals_of_main: 400,
    calls: 500,
    call_chain: 300,
    cases: 500,
    functions: 200,
    loops: 200,
    initialisers: 4000,
    macros: 500,
    struct_copies: 400,
    struct_stores: 400,
    pointer_chains: 500,
    strings: 1000,
}
