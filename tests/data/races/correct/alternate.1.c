#include "KMotionDef.h"

#define TURN persist.UserData[20]

main()
{
    int i;

    for (i = 0; i < 200; i++)
    {
        while (TURN != 0)
            ;
        persist.UserData[21]++;
        TURN = 1;
    }
}
