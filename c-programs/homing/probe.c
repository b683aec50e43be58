// cc67: run also 2:probe_plate.c
//
// probe.c - touching a surface and keeping where it was.
//
//   cc67 run 1:c-programs/homing/probe.c 2:c-programs/homing/probe_plate.c
//
// The tool goes down until the probe closes. The positions of all axes are taken in
// that instant, before the stop: the axis needs some way to come to rest. They are
// left as doubles for the PC, with a status: 1 the probe was closed from the start,
// 2 touched, 0 never touched. Thread 2 plays the plate on a virtual bit.
//
// Expect a touch at about Z -432, a stop below it, and the return to the touched place.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define PROBE_BIT 1024
#define END_BIT   1031
#define RESULTS   50        // persist: X, Y and Z as doubles in 50 to 55
#define STATUS    62        // persist

#define NOT_TOUCHED 0
#define CLOSED      1
#define TOUCHED     2

void Capture(double *To)
{
    To[0] = chan[CS0_axis_x].Dest;
    To[1] = chan[CS0_axis_y].Dest;
    To[2] = chan[CS0_axis_z].Dest;
}

void StopAll(void)
{
    StopCoordinatedMotion();
    // not CheckDoneXYZABC, which stays 0 until the feedhold is cleared
    while (!CheckDone(CS0_axis_z)) WaitNextTimeSlice();
    ClearStopImmediately();
}

int Probe(double Depth, float Speed, double *Result)
{
    if (ReadBit(PROBE_BIT)) return CLOSED;

    MoveAtVel(CS0_axis_z, Depth, Speed);
    while (!CheckDone(CS0_axis_z))
    {
        if (ReadBit(PROBE_BIT))
        {
            Capture(Result);
            StopAll();
            return TOUCHED;
        }
        WaitNextTimeSlice();
    }
    return NOT_TOUCHED;
}

main()
{
    int i;
    double *Result = (double *)&persist.UserData[RESULTS];

    for (i = 0; i < 3; i++) SetupStepAxis(i, 10000.0f, 50000.0f, 1e6f);
    DefineCoordSystem(0, 1, 2, -1);
    VirtualBitsEx[0] = 0;
    StartThread(2);
    Delay_sec(0.01);

    persist.UserData[STATUS] = Probe(-2000.0, 1000.0f, Result);
    printf("status %d\n", persist.UserData[STATUS]);
    printf("touched at X %.0f Y %.0f Z %.0f\n", Result[0], Result[1], Result[2]);
    printf("stopped %s\n", chan[2].Dest < Result[2] - 1.0 ? "below" : "there");

    Move(CS0_axis_z, Result[2]);
    WaitForAxis(CS0_axis_z);
    printf("back %s\n", chan[2].Dest == Result[2] ? "at the touched place" : "somewhere else");

    SetBit(END_BIT);
}
