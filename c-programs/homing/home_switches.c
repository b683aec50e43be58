// cc67: part of home3.c
//
// home_switches.c - plays a machine with three home switches.
//
// The machine does not know how the axes are numbered: it adds up what the motors
// move. When an axis is zeroed, its number jumps but the motor does not; no motor
// moves 500 steps in one slice, so such a jump is not counted.

#include "KMotionDef.h"
#include "home_switches.h"

#define AXES 3
#define JUMP 500.0

int Switch[AXES] = { -3000, -2200, -1500 };     // closed at and below this position

double Machine[AXES];
double Last[AXES];

void Follow(int Axis)
{
    double Dest = chan[Axis].Dest;
    double Step = Dest - Last[Axis];

    if (fast_fabs(Step) < JUMP) Machine[Axis] += Step;
    Last[Axis] = Dest;

    persist.UserData[MACHINE_AT + Axis] = (int)Machine[Axis];
    SetStateBit(SWITCH_BIT + Axis, Machine[Axis] <= Switch[Axis]);
}

main()
{
    int i;

    for (i = 0; i < AXES; i++)
    {
        Machine[i] = 0.0;
        Last[i] = chan[i].Dest;
        persist.UserData[SWITCH_AT + i] = Switch[i];
    }

    while (!ReadBit(HOMING_END))
    {
        for (i = 0; i < AXES; i++) Follow(i);
        WaitNextTimeSlice();
    }
}
