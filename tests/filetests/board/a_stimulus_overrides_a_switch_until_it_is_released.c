//@ args: --machine parts/pressed.toml --stim parts/pressed.stim
//@ prints: 1 at 0.1 s
//@ prints: 0 at 0.3 s
//@ prints: 4 changes, 0 at the end
//@ says: the stimulus overrides the switch of axis 0 on bit 136, until `release bit 136`
#include "KMotionDef.h"

main()
{
    int level, last = ReadBit(136), changes = 0;
    double end = Time_sec() + 0.45;

    while (WaitNextTimeSlice() < end)
    {
        level = ReadBit(136);
        if (level != last) printf("%d at %.1f s\n", level, Time_sec());
        last = level;
    }
    end += 0.3;
    while (WaitNextTimeSlice() < end)
    {
        level = ReadBit(136);
        if (level != last) changes++;
        last = level;
    }
    printf("%d changes, %d at the end\n", changes, last);
}
