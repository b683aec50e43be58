// race-record:
#include "KMotionDef.h"

typedef struct
{
    int x, y, z, tool;
} JOB;

JOB *job = (JOB *)&persist.UserData[80];

main()
{
    JOB next;
    int i;

    for (i = 0; i < 3000; i++)
    {
        next.x = i;
        next.y = 2 * i;
        next.z = 3 * i;
        next.tool = i & 7;
        *job = next;  // <-
    }
    persist.UserData[90] = 1;
}
