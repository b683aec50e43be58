// Times are doubles that are compared with a start.
//@ prints: timeout after 0.25 s
//@ prints: 4 blinks
#include "KMotionDef.h"

main()
{
    double T0, T;
    int blinks = 0;

    T0 = Time_sec();
    while (Time_sec() - T0 < 0.25) WaitNextTimeSlice();
    T = Time_sec() - T0;
    printf("timeout after %.2f s\n", T);

    T0 = T = Time_sec();
    do
    {
        if (Time_sec() >= T + 0.1)
        {
            T += 0.1;
            blinks++;
        }
        WaitNextTimeSlice();
    } while (Time_sec() < T0 + 0.45);
    printf("%d blinks\n", blinks);
}
//@ cycles: 1040185
