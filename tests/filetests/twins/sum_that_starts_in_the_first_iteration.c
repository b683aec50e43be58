//@ prints: 3
#include "KMotionDef.h"

main()
{
    int i, sum;
    for (i = 0; i < 3; i++)
    {
        if (i == 0) sum = 0;
        sum += i;
    }
    printf("%d\n", sum);
}
