// Operands that do not fit, each with its message.
//@ exit: 1
struct place { int x, y; } a;
struct other { int z; } o;

static int fixed(int n)
{
    char *list;
    va_start(list, n); //~ error: `va_start` in a function without variable arguments
    return n;
}

static int listed(int n, ...)
{
    va_start(a, n); //~ error: a `va_list` is needed, not `struct place`
    return n;
}

main()
{
    int n = 1, *p = &n;
    double d = 2;

    n ? a : o; //~ error: the branches of `?:` have incompatible types: `struct place` and `struct other`
    n ? a : n; //~ error: the branches of `?:` have incompatible types: `struct place` and `int`
    n ? p : d; //~ error: the branches of `?:` have incompatible types: `int *` and `double`
    p -= d; //~ error: `-=` cannot be used on `int *` and `double`
    p *= 2; //~ error: `*=` cannot be used on `int *` and `int`
    d &= 1; //~ error: `&=` cannot be used on `double` and `int`
    p - d; //~ error: `-` cannot be used on `int *` and `double`
    p + p; //~ error: `+` cannot be used on `int *` and `int *`
    n->x; //~ error: `->x` needs a pointer to a structure, but this is `int`
    p[p]; //~ error: an index must be an integer, not `int *`
    -p; //~ error: `-` needs a number, but this is `int *`
    -a; //~ error: `struct place` is used where a number or pointer is needed
    5 = n; //~ error: a value cannot be assigned to
}
