//@ args: check -Wmaybe-uninitialized
// Locals that hold a value at every read, however the statements run.
#include "KMotionDef.h"

int Branches(int n)
{
    int a, b, c, d;
    if (n > 5) a = 1; else a = 2;
    if (n > 5) { b = 1; } else return 0;
    if (n > 3 && (c = n * 2) > 7) return c;
    if (n < 3 || (d = n) == 0) return 0;
    return a + b + d;
}

int Loops(int n)
{
    int a, b, c, d;
    do { a = ReadBit(n); } while (a == 0);
    for (;;)
    {
        b = ReadBit(n);
        if (b) break;
        WaitNextTimeSlice();
    }
    while (1)
    {
        c = 3;
        if (ReadBit(n + 1)) continue;
        d = c;
        break;
    }
    return a + b + c + d;
}

int Switches(int n)
{
    int a, b;
    switch (n)
    {
    case 1: a = 1; break;
    case 2:
    case 3: a = 2; break;
    default: a = 3;
    }
    while (n--)
    {
        switch (n)
        {
        case 0: continue;
        case 1: b = 1; break;
        default: return 0;
        }
        a += b;
    }
    return n > 0 ? (b = n, b) : a;
}

main()
{
    printf("%d %d %d\n", Branches(1), Loops(2), Switches(3));
}
