#include "KMotionDef.h"

typedef struct
{
    int x, y, z, tool;
} JOB;

main()
{
    JOB *job = (JOB *)&persist.UserData[80];
    JOB mine;
    int bad = 0;

    while (!persist.UserData[90])
    {
        mine = *job;  // <-
        if (mine.y != 2 * mine.x || mine.z != 3 * mine.x)
            bad++;
    }
    persist.UserData[91] = bad;
}
