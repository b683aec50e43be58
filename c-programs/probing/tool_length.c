// cc67: run
//
// tool_length.c - measuring the length of a tool on a tool setter.
//
//   cc67 run --machine c-programs/probing/tool_length.toml c-programs/probing/tool_length.c
//
// Down fast until the setter closes, up until it opens, and again slowly: the second
// touch counts. From the height of the setter and that of the machine follows the length.
// A setter that is closed already, or never closes, ends the measurement.
//
// Expect a touch at -5200 and a tool of 48 mm.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define Z            2
#define SETTER       138
#define STEPS_PER_MM 100.0
#define NOSE_HEIGHT  150.0          // spindle nose above the table at Z 0, in mm
#define SETTER_TOP   50.0           // its surface above the table, in mm
#define LOWEST       (-5800.0)      // further down it must not go
#define FAST         2000.0f
#define SLOW         100.0f

// Goes down to the setter; where it closed, or FALSE.
int Touch(float Speed, double *Where)
{
    MoveAtVel(Z, LOWEST, Speed);
    while (!ReadBit(SETTER))
    {
        WaitNextTimeSlice();
        if (CheckDone(Z)) return FALSE;
    }
    *Where = chan[Z].Dest;
    Jog(Z, 0.0);
    WaitForAxis(Z);
    return TRUE;
}

void Leave(void)
{
    Jog(Z, 1000.0);
    while (ReadBit(SETTER)) WaitNextTimeSlice();
    MoveRelAtVel(Z, 50.0, 1000.0f);
    WaitForAxis(Z);
}

main()
{
    double Where;

    SetupStepAxis(Z, 20000.0f, 200000.0f, 4e6f);
    if (ReadBit(SETTER))
    {
        printf("the setter is closed already\n");
        return;
    }
    if (!Touch(FAST, &Where))
    {
        printf("no tool, or no setter\n");
        return;
    }
    Leave();
    if (Touch(SLOW, &Where))
    {
        printf("touched at %.0f steps\n", Where);
        printf("length %.2f mm\n", NOSE_HEIGHT + Where / STEPS_PER_MM - SETTER_TOP);
    }
    Move(Z, 0.0);
    WaitForAxis(Z);
}
