// A hand wheel: differences of an encoder count, scaled by a switch, moved in small steps.
//@ prints: 7 clicks, 0.35 mm
//@ prints: axis asked for 0.35
#include "KMotionDef.h"

#define MPG_CHAN 7
#define AXIS 0
#define X1 0.05 // mm for a click

int Clicks[] = { 0, 1, 3, 3, 6, 7, 7 };

main()
{
    int Pos, LastPos = 0, Change1, i, total = 0;
    double Factor = X1, Sum = 0;

    for (i = 0; i < 7; i++)
    {
        chan[MPG_CHAN].Position = Clicks[i];
        Pos = chan[MPG_CHAN].Position;
        Change1 = Pos - LastPos;
        LastPos = Pos;
        if (Change1)
        {
            total += Change1;
            Sum += Change1 * Factor;
        }
        WaitNextTimeSlice();
    }
    printf("%d clicks, %.2f mm\n", total, Sum);
    persist.UserData[0] = AXIS;
    *(float *)&persist.UserData[1] = Sum;
    printf("axis asked for %.2f\n", *(float *)&persist.UserData[1]);
}
//@ cycles: 15582
