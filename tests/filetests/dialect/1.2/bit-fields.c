//@ prints: d 1 0 0
//@ prints: 4 4 8 -3 5
#include "KMotionDef.h"

struct A { int a : 3, b : 5, c : 24; } a = { 5, 1, 1 };
struct B { int a : 20, b : 20; };
struct C { char a : 4; int : 0; char b : 4; };
struct D { int s : 3; unsigned u : 3; } d = { 5, 5 };
_Static_assert(sizeof(struct A) == 4 && sizeof(struct B) == 8, "no straddling");

main()
{
    unsigned char *bytes = (unsigned char *)&a;
    printf("%x %x %x %x\n", bytes[0], bytes[1], bytes[2], bytes[3]);
    printf("%d %d %d %d %d\n", sizeof a, sizeof d, sizeof(struct B), d.s, d.u);
}
//@ cycles: 19534
