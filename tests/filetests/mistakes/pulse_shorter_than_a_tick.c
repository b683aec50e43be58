//@ args: --stim parts/short.stim
//@ prints: 0 turns
//@ says: the pulse at bit 137 takes 50 µs, less than a tick of 90 µs: a program that reads the bit in each of its slices can miss it
#include "KMotionDef.h"

main()
{
    int n = 0, was = 0, now;

    while (Time_sec() < 0.3)
    {
        now = ReadBit(137);
        if (now && !was)
            n++;
        was = now;
        WaitNextTimeSlice();
    }
    printf("%d turns\n", n);
}
