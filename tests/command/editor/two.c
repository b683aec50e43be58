#include "KMotionDef.h"

int turns;

main()
{
    for (;;)
    {
        turns = turns + 1;
        WaitNextTimeSlice();
    }
}
