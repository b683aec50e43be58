//@ args: 2:parts/prints_parts.c
//@ says: thread 2 at prints_parts.c:8:9 in `main`: prints into the line that thread 1 has begun: print each line with one call
//@ prints: X=Y=0
//@ prints: X=0
//@ prints: Y=1
//@ prints: X=1
//@ prints: Y=2
//@ prints: 2
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 3; i++)
    {
        printf("X=");
        WaitNextTimeSlice();
        printf("%d\n", i);
    }
}
