// cc67: run
//
// feedhold.c - stopping all axes of the coordinate system, and going on.
//
//   cc67 run c-programs/motion/feedhold.c
//
// A feedhold brings the axes to rest within their acceleration and remembers where
// they were going. CheckDone says 1 while holding, so a program that wants to know
// whether the target is reached asks for the state of the feedhold too.
//
// Expect a stop on the way, the target after the resume, and the second move given
// up by the clear.

#include "KMotionDef.h"
#include "step_axis.c"

#define HELD 4              // CS0_StoppingState: independent moves have stopped

int Arrived(int Axis)
{
    return CheckDone(Axis) && CS0_StoppingState == 0;
}

void Hold(void)
{
    StopCoordinatedMotion();
    while (CS0_StoppingState != HELD)
    {
        WaitNextTimeSlice();
        UpdateStoppingState();
    }
}

void Where(char *When)
{
    printf("%-14s CheckDone %d, %s\n", When, CheckDone(0), Arrived(0) ? "arrived" : "on the way");
}

main()
{
    SetupStepAxis(0, 10000.0f, 100000.0f, 1e6f);
    SetupStepAxis(1, 10000.0f, 100000.0f, 1e6f);
    DefineCoordSystem(0, 1, -1, -1);

    Move(0, 10000.0);
    Move(1, 5000.0);
    Delay_sec(0.3);
    Where("moving:");
    Hold();
    Where("holding:");
    ResumeCoordinatedMotion();
    while (!Arrived(0) || !Arrived(1)) WaitNextTimeSlice();
    Where("resumed:");
    printf("X %.0f Y %.0f\n", chan[0].Dest, chan[1].Dest);

    Move(0, 0.0);
    Delay_sec(0.3);
    Hold();
    ClearStopImmediately();
    ResumeCoordinatedMotion();              // there is nothing left to resume
    Delay_sec(0.3);
    printf("given up:      X %s\n", chan[0].Dest > 0.0 ? "stays where it stopped" : "went on");
}
