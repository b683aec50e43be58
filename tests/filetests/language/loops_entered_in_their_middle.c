//@ prints: 8000
// Loops that are entered by `goto`, with calls inside. The way in has two branches that do not fit one cycle of the
// processor, so nothing may move behind the first of them.
#include "KMotionDef.h"

static unsigned mix(unsigned sum, unsigned value)
{
    return ((sum << 5) | (sum >> 27)) ^ value * 2654435761u;
}

static unsigned jumps(unsigned sum, int x, unsigned y, long long z, double w)
{
    int i = 0;
    int n = x & 63, k = 0, steps = 0;

    if (((n / ((k & 63) + 2))) & 3)
        while (k++ < 8)
        {
          again:
            if (((117 && (int)z)) & 3)  //~ logical-constant
                goto inside;
        }
    while (k++ < 8)
    {
        if (((k % ((188 & 63) + 2))) & 3)
          inside:
            goto last;
    }
    while (++k < 2 && ++steps < 300)
        ;
    while (k++ < 5)
    {
      last:
        if (++steps > 300)
            if (((255 | i)) & 3)
                goto again;
    }
    return mix(sum, i);
}

main()
{
    unsigned sum = 1;
    int i;

    for (i = 0; i < 3; i++)
        sum = jumps(sum, i * 514767 - 43, sum, i * 51476700077LL - (long long)sum * 43, i * 1.75 - 43.5);
    printf("%x\n", sum);
}
