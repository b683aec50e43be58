// step_axis.c - included by other programs: one step and direction axis.
//
// A motor that follows its step pulses without feedback needs little: the modes,
// the generator, the limits of the motion, and the three filters of the servo left
// at 1. Everything else keeps its power-up value.

#ifndef STEP_AXIS_C
#define STEP_AXIS_C

#include "KMotionDef.h"

// Step generators 0 to 7 with driven (not open collector) outputs are 8 to 15.
#define DRIVEN 8

void SetupStepAxis(int Axis, float Vel, float Accel, float Jerk)
{
    CHAN *ch = &chan[Axis];

    DisableAxis(Axis);

    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = STEP_DIR_MODE;
    ch->OutputChan0 = DRIVEN + Axis;
    ch->OutputGain = 1.0f;
    ch->MasterAxis = -1;
    ch->LimitSwitchOptions = 0;
    ch->BacklashMode = BACKLASH_OFF;

    ch->Vel = Vel;              // steps/s
    ch->Accel = Accel;          // steps/s^2
    ch->Jerk = Jerk;            // steps/s^3

    EnableAxisDest(Axis, 0.0);
}

// Waits until the axis has finished its move, or has been disabled.
void WaitForAxis(int Axis)
{
    while (!CheckDone(Axis)) WaitNextTimeSlice();
}

#endif
