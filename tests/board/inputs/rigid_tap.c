// Rigid tapping as a PC application asks for it: six parameters in pairs of elements as doubles, a notification
// 10084 in element 6, and a flag in elements 30 and 31 when it is done.
#include "KMotionDef.h"

#define ZAXIS 7
#define SPINDLE_AXIS 6
#define Z_CNTS_PER_INCH -20000.0
#define CNTS_PER_REV (8192*14/16)
#define TAU 0.001

double SlaveGain, z0, s0;

void DoSlave(void)
{
    MoveExp(ZAXIS, (chan[SPINDLE_AXIS].Dest - s0) * SlaveGain + z0, TAU);
    WaitNextTimeSlice();
}

void DoTap(double Dist, double Rate, double TPI)
{
    MoveRelAtVel(SPINDLE_AXIS, Dist * TPI * CNTS_PER_REV, Rate * TPI * CNTS_PER_REV);
    while (!CheckDone(SPINDLE_AXIS)) DoSlave();
    printf("depth %.3f\n", (chan[ZAXIS].Dest - z0) / Z_CNTS_PER_INCH);
}

double Parameter(int Element)
{
    return *(double *)&persist.UserData[Element];
}

void Tap(void)
{
    double TPI = Parameter(18), Total = Parameter(24), Forward = Parameter(26), Back = Parameter(28);
    double Feed = Parameter(20) / (TPI * 60.0), Retract = Parameter(22) / (TPI * 60.0);
    double Cut = 0.0;

    SlaveGain = Z_CNTS_PER_INCH / (CNTS_PER_REV * TPI);
    z0 = chan[ZAXIS].Dest;
    s0 = chan[SPINDLE_AXIS].Dest;
    while (Cut < Total)
    {
        if (Cut + Forward > Total)
        {
            DoTap(Total - Cut, Feed, TPI);
            DoTap(-Total, Retract, TPI);
            Cut = Total;
        }
        else
        {
            DoTap(Forward, Feed, TPI);
            DoTap(-Back, Retract, TPI);
            Cut += Forward - Back;
        }
    }
    Delay_sec(1.0);
    Move(ZAXIS, z0);
    while (!CheckDone(ZAXIS)) ;
    *(double *)&persist.UserData[30] = 1.0;
    printf("Tap Complete\n");
}

main()
{
    printf("Mach3 Notify Call, Message = %d\n", persist.UserData[6]);
    if (persist.UserData[6] == 10084) Tap();
}
