#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 1000; i++)
    {
        AtomicSet(&persist.UserData[5], 1);
        AtomicClear(&persist.UserData[5], ~1);
    }
}
