// cc67: run
//
// speed_mode.c - a hand wheel that commands a speed: the axis stops when the wheel stops.
//
//   cc67 run --stim c-programs/mpg/speed_mode.stim c-programs/mpg/speed_mode.c
//
// With a jog instead of moves there is nothing to catch up with. The speed of the wheel is
// measured over 50 ms, and smoothed, as a hand turns unevenly. Small speeds count as none,
// or the axis would creep.
//
// Expect about 2000 steps a second, then 16000, then none.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define WHEEL  3
#define AXIS   0
#define GAIN   10.0                 // steps for a count
#define PERIOD 0.05                 // seconds
#define SMOOTH 0.5                  // 0 smooths nothing, close to 1 a lot
#define LEAST  100.0                // steps a second

main()
{
    double Next, Last, Turned, Speed = 0.0, Before = 0.0, End, Report = 0.5;

    SetupStepAxis(AXIS, 40000.0f, 400000.0f, 4e6f);
    chan[WHEEL].InputMode = ENCODER_MODE;
    Last = chan[WHEEL].Position;
    Next = Time_sec();
    End = Next + 2.6;

    while (Next < End)
    {
        Next += PERIOD;
        WaitUntil(Next);
        Turned = chan[WHEEL].Position - Last;
        Last += Turned;
        Speed = SMOOTH * Speed + (1.0 - SMOOTH) * Turned * GAIN / PERIOD;
        if (fast_fabs(Speed) < LEAST) Speed = 0.0;
        if (Speed != Before) Jog(AXIS, Speed);
        Before = Speed;

        if (Next >= Report)
        {
            printf("%.1f s: %5.0f steps/s\n", Report, Speed);
            Report += 0.5;
        }
    }
    printf("at rest: %s\n", CheckDone(AXIS) ? "yes" : "no");
}
