// cc67: run
//
// height.c - torch height control: the voltage of the arc tells how far the torch is away.
//
//   cc67 run --machine c-programs/plasma/height.toml c-programs/plasma/height.c
//
// The longer the arc, the higher its voltage. While X cuts, Z is jogged up or down by what
// the voltage is off, with a limit and a dead band. In a corner X is slow, the arc burns a
// wider gap and its voltage rises: the torch would dive. So below 90 % of the speed Z stays
// where it is.
//
// The machine file beside this program makes the voltage out of the height of Z. The cut
// begins 400 steps too high.
//
// Expect 136 V, then about 120 V, and no correction at either end of the cut.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define X          0
#define Z          2
#define ARC        0                // analog input
#define VOLTS      0.1              // of a count
#define WANTED     120.0
#define DEAD_BAND  0.5              // volts
#define GAIN       100.0            // steps a second for a volt
#define MAX_SPEED  500.0            // steps a second
#define FEED       4000.0           // of X
#define LENGTH     20000.0

double ArcVolts(void)
{
    return ADC(ARC) * VOLTS;
}

double Correction(double Volts)
{
    double Speed = GAIN * (WANTED - Volts);

    if (fast_fabs(WANTED - Volts) < DEAD_BAND) return 0.0;
    if (Speed > MAX_SPEED) return MAX_SPEED;
    return Speed < -MAX_SPEED ? -MAX_SPEED : Speed;
}

main()
{
    double Now, Last, X0, Speed, Report;
    int Active = FALSE, WasActive = FALSE;

    SetupStepAxis(X, FEED, 10000.0f, 100000.0f);
    SetupStepAxis(Z, 4000.0f, 40000.0f, 4e6f);
    Move(Z, 1400.0);
    WaitForAxis(Z);
    Delay_sec(0.01);

    Last = Report = Time_sec();
    X0 = chan[X].Dest;
    Move(X, LENGTH);
    while (!CheckDone(X))
    {
        Delay_sec(0.01);
        Now = Time_sec();
        Speed = (chan[X].Dest - X0) / (Now - Last);
        Last = Now;
        X0 = chan[X].Dest;

        Active = Speed > 0.9 * FEED;
        Jog(Z, Active ? Correction(ArcVolts()) : 0.0);
        if (Active != WasActive) printf("correction %s at X %d\n", Active ? "on" : "off", (int)(X0 + 0.5));
        WasActive = Active;
        if (Now >= Report)
        {
            printf("X %5d: %.1f V, Z %.0f\n", (int)chan[X].Dest, ArcVolts(), chan[Z].Dest);
            Report += 1.0;
        }
    }
    Jog(Z, 0.0);
}
