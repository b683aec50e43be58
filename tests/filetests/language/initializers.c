// Initialisers: nested, unbraced, designated, strings, addresses, partly initialised locals.
//@ prints: 1 2 3 4 0 0
//@ prints: abc 4 5 0
//@ prints: 0 7 0 9
//@ prints: 12 two
//@ prints: 6 0 0 8
#include "KMotionDef.h"

int table[2][3] = { { 1, 2, 3 }, { 4 } };
char text[] = "abc";
int flat[2][2] = { 4, 5 };
int sparse[] = { [1] = 7, [3] = 9 };
char *names[] = { "one", "two" };
int *where = &table[1][0];
int (*calls[])(int) = { 0, ReadBit };

main()
{
    int local[4] = { 6 };
    struct { int a, b; } pair = { .b = 8 };
    printf("%d %d %d %d %d %d\n", table[0][0], table[0][1], table[0][2], *where, where[1], where[2]);
    printf("%s %d %d %d\n", text, sizeof text, flat[0][1], flat[1][0]);
    printf("%d %d %d %d\n", sparse[0], sparse[1], sparse[2], sparse[3]);
    printf("%d %s\n", sizeof sparse - 4, names[1]);
    printf("%d %d %d %d\n", local[0], local[3], pair.a, pair.b);
}
//@ cycles: 43496
