// spindle_jog.c - included by the spindle programs: a spindle that is jogged as an axis.
//
// State and speed are in persist, as each program ends when its work is done and the
// next one, for another M code, must know what the spindle does.

#ifndef SPINDLE_JOG_C
#define SPINDLE_JOG_C

#include "KMotionDef.h"
#include "../motion/step_axis.c"
#include "MySpindleDefs.h"

#define COUNTS_PER_SEC(rpm) ((rpm) / 60.0 * COUNTS_PER_TURN)

float GetSpeed(void)
{
    return *(float *)&persist.UserData[SPEED_VAR];
}

void SetSpeed(float Rpm)
{
    if (Rpm < 0.0f) Rpm = 0.0f;
    if (Rpm > MAX_RPM)
    {
        printf("%.0f rpm is too fast, %.0f rpm is taken\n", Rpm, MAX_RPM);
        Rpm = MAX_RPM;
    }
    *(float *)&persist.UserData[SPEED_VAR] = Rpm;
}

void EnableSpindle(void)
{
    SetupStepAxis(SPINDLE_AXIS, COUNTS_PER_SEC(MAX_RPM), COUNTS_PER_SEC(RAMP), 1e7f);
}

// What the axis does now, in turns per minute, measured over a tenth of a second.
double MeasuredRpm(void)
{
    double From = chan[SPINDLE_AXIS].Dest;
    double Start = Time_sec();

    WaitUntil(Start + 0.1);
    return (chan[SPINDLE_AXIS].Dest - From) / (Time_sec() - Start) / COUNTS_PER_TURN * 60.0;
}

// Jogs at the speed and in the direction that are stored.
void RunSpindle(int State)
{
    persist.UserData[STATE_VAR] = State;
    if (!chan[SPINDLE_AXIS].Enable) EnableSpindle();
    Jog(SPINDLE_AXIS, State * COUNTS_PER_SEC(GetSpeed()));
}

void WaitForRamp(void)
{
    Delay_sec(MAX_RPM / RAMP + 0.5);
}

#endif
