//@ args: --for 1 --stim parts/early_pulse.stim
//@ says: at the end, after 1.000 s of board time:
//@ says:   thread 1 at pulse_before_anybody_waits_for_it.c:9:27 in `main` has waited since 0.000 s for bit 136 (now 0), which had a pulse from 0.100 s to 0.120 s, before the wait
#include "KMotionDef.h"

main()
{
    Delay_sec(0.5);
    while (!ReadBit(136)) WaitNextTimeSlice();
    printf("pressed\n");
}
