// Structures: layout, assignment, arguments and results by value, bit-fields, arrays of structures.
//@ prints: 24 8 16
//@ prints: 3 4.5 7
//@ prints: 11 4.5
//@ prints: 5 -1 1 d
#include "KMotionDef.h"

struct A { char c; double d; char e; };
struct B { char c[3]; short s; char e; };
union U { char c; double d; int i[3]; };
typedef struct { int n; double x; } Pair;
struct Bits { int a : 3; int b : 5; unsigned c : 24; };

Pair add(Pair p, int n) { p.n += n; return p; }
void change(Pair p) { p.n = 99; } //~ parameter-copy

main()
{
    Pair a = { 3, 4.5 }, b, list[2] = { { 1, 1.5 }, { 7 } };
    struct Bits bits = { 5, -1, 1 };
    printf("%d %d %d\n", sizeof(struct A), sizeof(struct B), sizeof(union U));
    change(a);
    printf("%d %.1f %d\n", a.n, a.x, list[1].n);
    b = add(a, 8);
    printf("%d %.1f\n", b.n, b.x);
    printf("%d %d %d %x\n", bits.a & 7, bits.b, bits.c, *(int *)&bits & 0xf);
}
//@ cycles: 30035
