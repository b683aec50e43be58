//@ args: check
#include "KMotionDef.h"

int Minutes = 45, Shots = 3;

main()
{
    int n;
    double interval = Minutes * 60.0 * 1000000, seconds = Minutes * 60;

    Shots = persist.UserData[20];
    printf("%d %f %f\n", Shots * 1000000000, interval, seconds);
    for (n = 0; n < Shots && !(-5 < ch0->Dest && ch0->Dest < 5); n++) Delay_sec(seconds);
}
