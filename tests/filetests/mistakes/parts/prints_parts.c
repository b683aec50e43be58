#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 3; i++)
    {
        printf("Y=");
        WaitNextTimeSlice();
        printf("%d\n", i);
    }
}
