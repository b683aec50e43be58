// cc67: run also 2:home_switches.c
//
// home3.c - homing three axes to their switches.
//
//   cc67 run 1:c-programs/homing/home3.c 2:c-programs/homing/home_switches.c
//
// Each axis runs fast to its switch, backs off slowly until the switch opens, takes
// that place as zero, and moves clear. Z goes first, so that the tool is out of the
// way. A switch that never comes ends the homing, not the motor. Thread 2 plays the
// switches on virtual bits; on a machine they are inputs such as 136 to 138.
//
// Expect Z, X and Y homed, each close to its switch.

#include "KMotionDef.h"
#include "../motion/step_axis.c"
#include "home_switches.h"

#define TIME_OUT 10.0       // seconds for any one search

typedef struct
{
    char Letter;
    int Axis;
    double Fast;            // towards the switch, steps/s, with its sign
    double Slow;            // away from it
    double Clear;           // where to wait afterwards, steps from zero
} HOMING;

HOMING Order[3] =
{
    { 'Z', 2, -8000.0, 200.0, 500.0 },
    { 'X', 0, -10000.0, 400.0, 1000.0 },
    { 'Y', 1, -10000.0, 400.0, 1000.0 }
};

// Jogs until the switch has the given level, then stops. FALSE: too long.
int JogUntil(int Axis, double Speed, int Level)
{
    double Limit = Time_sec() + TIME_OUT;
    int Found = TRUE;

    Jog(Axis, Speed);
    while (ReadBit(SWITCH_BIT + Axis) != Level && Found)
    {
        if (WaitNextTimeSlice() > Limit) Found = FALSE;
    }
    Jog(Axis, 0.0);
    WaitForAxis(Axis);
    return Found;
}

int Home(HOMING *h)
{
    if (!JogUntil(h->Axis, h->Fast, 1)) return FALSE;
    if (!JogUntil(h->Axis, h->Slow, 0)) return FALSE;

    persist.UserData[ZERO_AT + h->Axis] = persist.UserData[MACHINE_AT + h->Axis];
    Zero(h->Axis);
    Move(h->Axis, h->Clear);
    WaitForAxis(h->Axis);
    return TRUE;
}

// The other thread knows where the switches are; a real machine does not tell.
char *Judge(int Axis)
{
    int Error = persist.UserData[ZERO_AT + Axis] - persist.UserData[SWITCH_AT + Axis];

    return Error >= -10 && Error <= 10 ? "at its switch" : "not at its switch";
}

main()
{
    int i;

    for (i = 0; i < 3; i++) SetupStepAxis(i, 20000.0f, 200000.0f, 4e6f);
    VirtualBitsEx[0] = 0;
    StartThread(2);

    for (i = 0; i < 3; i++)
    {
        if (!Home(&Order[i]))
        {
            printf("%c: switch not found\n", Order[i].Letter);
            break;
        }
        printf("%c: zero %s, waiting at %.0f\n", Order[i].Letter, Judge(Order[i].Axis),
               chan[Order[i].Axis].Dest);
    }

    SetBit(HOMING_END);             // lets the other thread end
}
