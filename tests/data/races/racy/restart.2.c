#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0; i < 30; i++)
        Delay_sec(0.001);
}
