//@ prints: 10 3 2 5 -1
#include "KMotionDef.h"

last(int limit)
{
    int i, sum = 0;
    for (i = 0;; i++) {
        if (i == 2) continue;
        if (i > limit) break;
        sum += i;
    }
    return sum;
}

main()
{
    int n = 0, m = 5;
    while (n < 3) n++;
    do m--; while (m > 2);
    printf("%d %d %d ", last(4) + 2, n, m);
    switch (n) {
    case 1: printf("wrong "); break;
    case 3: printf("5 "); break;
    default: printf("wrong ");
    }
    if (n < 0) printf("wrong\n"); else printf("%d\n", -1);
}
//@ cycles: 10386
