// cc67: run
//
// gantry.c - homing and squaring a gantry with a motor and a switch on each side.
//
//   cc67 run --machine c-programs/homing/gantry.toml c-programs/homing/gantry.c
//
// Both sides run to their switches together, and each stops at its own. Then both back
// off, again each until its own switch opens: now the gantry is square, and both sides
// are zero. From then on the right side copies the left one, and the coordinate system
// has the left one only.
//
// The machine file beside this program begins with the right side 80 steps ahead.
//
// Expect these 80 steps, and both sides moving together.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define LEFT  1
#define RIGHT 3

int Sides[2] = { LEFT, RIGHT };
int Switches[2] = { 136, 137 };
double FoundAt[2];

// Jogs both sides; each stops when its switch has the level.
void BothUntil(double Speed, int Level)
{
    int i, Running = 3;

    for (i = 0; i < 2; i++) Jog(Sides[i], Speed);
    while (Running)
    {
        for (i = 0; i < 2; i++)
        {
            if ((Running & 1 << i) && ReadBit(Switches[i]) == Level)
            {
                FoundAt[i] = chan[Sides[i]].Dest;
                Jog(Sides[i], 0.0);
                Running &= ~(1 << i);
            }
        }
        WaitNextTimeSlice();
    }
    for (i = 0; i < 2; i++) WaitForAxis(Sides[i]);
}

main()
{
    int i;

    for (i = 0; i < 2; i++) SetupStepAxis(Sides[i], 20000.0f, 200000.0f, 4e6f);

    BothUntil(-5000.0, 1);
    BothUntil(200.0, 0);
    printf("the sides were askew by %.0f steps\n", FoundAt[0] - FoundAt[1]);

    for (i = 0; i < 2; i++)
    {
        MoveAtVel(Sides[i], FoundAt[i], 200.0f);
        WaitForAxis(Sides[i]);
        Zero(Sides[i]);
    }

    chan[RIGHT].MasterAxis = LEFT;
    chan[RIGHT].SlaveGain = 1.0;
    Move(LEFT, 1000.0);
    WaitForAxis(LEFT);
    printf("left at %.0f, right at %.0f\n", chan[LEFT].Dest, chan[RIGHT].Dest);
}
