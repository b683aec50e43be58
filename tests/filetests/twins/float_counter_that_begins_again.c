//@ prints: 3
#include "KMotionDef.h"

main()
{
    float turns = 0, place;
    for (;;)
    {
        turns += 1;
        for (place = 0; place < 2; place += 0.5) WaitNextTimeSlice();
        if (turns > 2) break;
    }
    printf("%.0f\n", turns);
}
