// What has no size, no address or no members, each with its message.
//@ exit: 1
struct unknown;
union bits { int all; struct { int low : 4; } part; } bits;

main()
{
    struct unknown *u = 0;
    double d = 2;

    u + 1; //~ error: the size of `struct unknown` is unknown, so pointer arithmetic is not possible
    u->x; //~ error: `struct unknown` is declared but not defined: its members are unknown
    &bits.part.low; //~ error: a bit-field has no address
    sizeof bits.part.low; //~ error: a bit-field has no size in bytes
    sizeof(struct unknown); //~ error: the size of `struct unknown` is unknown
    _Generic(d, int: 1); //~ error: no association of `_Generic` has the type `double`
    __builtin_offsetof(union bits, part.low); //~ error: a bit-field has no offset in bytes
    __builtin_offsetof(int, x); //~ error: `int` has no members
}
