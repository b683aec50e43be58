//@ prints: 24 0 8 16
//@ prints: 8 0 4 6
#include "KMotionDef.h"

struct A { char c; double d; char e; };
struct B { char c[3]; short s; char e; };
_Static_assert(sizeof(struct A) == 24 && _Alignof(struct A) == 8, "A");
_Static_assert(sizeof(struct B) == 8 && _Alignof(struct B) == 2, "B");
_Static_assert(__builtin_offsetof(struct A, d) == 8 && __builtin_offsetof(struct A, e) == 16, "A");
_Static_assert(__builtin_offsetof(struct B, s) == 4 && __builtin_offsetof(struct B, e) == 6, "B");

struct A a;
struct B b;

main()
{
    char *at = (char *)&a;
    printf("%d %d %d %d\n", sizeof a, (char *)&a.c - at, (char *)&a.d - at, (char *)&a.e - at);
    at = (char *)&b;
    printf("%d %d %d %d\n", sizeof b, (char *)&b.c - at, (char *)&b.s - at, (char *)&b.e - at);
}
//@ cycles: 17941
