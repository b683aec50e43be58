//@ args: --stim parts/short_pulses.stim
//@ prints: 2
//@ says: thread 1 at pulses_polled_too_rarely.c:11:15 in `main`: ReadBit(136): a pulse of 5.0 ms at this input has come and gone in the 50 ms since the read before, and nobody saw it: read more often, or make the pulse longer
#include "KMotionDef.h"

main()
{
    int i, n = 0, last = 0, now;
    for (i = 0; i < 20; i++)
    {
        now = ReadBit(136);
        if (now && !last) n++;
        last = now;
        Delay_sec(0.05);
    }
    printf("%d\n", n);
}
