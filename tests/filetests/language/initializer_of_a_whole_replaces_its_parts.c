// A second initialiser of a whole replaces all that was given to its parts; one of a part keeps the others.
//@ prints: 0 5 | 0 3 1 | 1 8 1
//@ prints: 0 6 | x 0 0 | 0 5
//@ prints: 0 9 2 | 0 4
#include "KMotionDef.h"

struct Pair { int a, b; };
struct Outer { struct Pair pair; int c; };

struct Pair list[2] = { [0] = { 1, 2 }, [0] = { .b = 5 } };
struct Outer first = { .pair.a = 7, .pair = { .b = 3 }, .c = 1 };
struct Outer second = { .pair = { 7, 8 }, .pair.a = 1, .c = 1 };
int table[2][2] = { [0][0] = 4, [0] = { [1] = 6 } };
char text[2][4] = { "abc", [0] = "x" };
struct Outer copied = { .pair.a = 7, .pair = (struct Pair){ .b = 9 }, .c = 2 };

main()
{
    struct Pair local[2] = { [0] = { 1, 2 }, [0] = { .b = 5 } };
    struct Pair range[3] = { [0 ... 2] = { 1, 2 }, [1] = { .b = 4 } };
    printf("%d %d | %d %d %d | %d %d %d\n", list[0].a, list[0].b, first.pair.a, first.pair.b, first.c,
           second.pair.a, second.pair.b, second.c);
    printf("%d %d | %c %d %d | %d %d\n", table[0][0], table[0][1], text[0][0], text[0][1], text[0][2], local[0].a,
           local[0].b);
    printf("%d %d %d | %d %d\n", copied.pair.a, copied.pair.b, copied.c, range[1].a, range[1].b);
}
