// switch with fall-through and ranges, goto, nested loops, comma, conditional, do.
//@ prints: one two-four two-four other
//@ prints: 10 3 16
//@ prints: 1 2 4 5
#include "KMotionDef.h"

char *name(int n)
{
    switch (n) {
    case 1: return "one";
    case 2 ... 4: return "two-four";
    default: return "other";
    }
}

main()
{
    int i, j, sum = 0, count = 0;
    printf("%s %s %s %s\n", name(1), name(2), name(4), name(5));
    for (i = 0, j = 5; i < 5; i++, j--) sum += i > 2 ? j : i + 1;
    do { count++; } while (count < 3);
    i = 1;
again:
    i *= 2;
    if (i < 16) goto again;
    printf("%d %d %d\n", sum + 1, count, i);
    for (i = 1;; i++) {
        if (i == 3) continue;
        if (i > 5) break;
        printf(i < 5 ? "%d " : "%d\n", i);
    }
}
//@ cycles: 27420
