//@ args: --stim ../mistakes/parts/short_pulses.stim
//@ prints: 10
#include "KMotionDef.h"

main()
{
    int n = 0, last = 0, now;
    double start = Time_sec();
    while (Time_sec() < start + 1)
    {
        now = ReadBit(136);
        if (now && !last) n++;
        last = now;
        WaitNextTimeSlice();
    }
    printf("%d\n", n);
}
