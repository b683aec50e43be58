// thread-restarted:
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 3; i++)
    {
        StartThread(2);  // <-
        Delay_sec(0.01);
    }
}
