//@ args: --stim parts/while.stim
//@ prints: 10
#include "KMotionDef.h"

main()
{
    int changes = 0, level = ReadBit(136);
    Delay_sec(0.1);
    SetBit(46);
    while (Time_sec() < 0.4)
    {
        if (Time_sec() > 0.2) ClearBit(46);
        if (ReadBit(136) != level)
        {
            level = ReadBit(136);
            changes++;
        }
    }
    printf("%d\n", changes);
}
