// Static locals remember the input between calls; a short bounce is not seen.
//@ prints: pressed at 6
//@ prints: released at 11
#include "KMotionDef.h"

#define STABLE 3

int Input[] = { 0, 1, 0, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0 };

int Debounce(int n, int *count, int *last, int *lastsolid)
{
    if (n == *last)
    {
        if (++*count == STABLE && n != *lastsolid)
        {
            *lastsolid = n;
            return n;
        }
    }
    else
    {
        *count = 1;
        *last = n;
    }
    return -1;
}

main()
{
    static int count = 0, last = 0, solid = 0;
    int i, result;
    for (i = 0; i < 13; i++)
    {
        result = Debounce(Input[i], &count, &last, &solid);
        if (result == 1) printf("pressed at %d\n", i + 1);
        if (result == 0) printf("released at %d\n", i + 1);
    }
}
//@ cycles: 9805
