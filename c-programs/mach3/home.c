// cc67: run --set persist.5=5
//
// home.c - homing for Mach3: the PC says which axes, the program answers when they are done.
//
//   cc67 run --machine c-programs/mach3/home.toml c-programs/mach3/home.c --set persist.5=5
//
// "Ref all home" sets a bit for each axis in one element of persist and starts the
// program: 1 X, 2 Y, 4 Z. A bit is cleared when its axis is home. So the PC sees the
// progress, and a bit that stays says which axis had trouble.
//
// Expect X and Z homed and no bit left; Y was not requested.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define FLAGS    5                  // persist
#define SWITCHES 136
#define TIME_OUT 5.0

double Towards[3] = { -5000.0, -5000.0, 3000.0 };   // to the switch, with its sign

int JogUntil(int Axis, double Speed, int Level)
{
    double Limit = Time_sec() + TIME_OUT;

    Jog(Axis, Speed);
    while (ReadBit(SWITCHES + Axis) != Level && Time_sec() < Limit) WaitNextTimeSlice();
    Jog(Axis, 0.0);
    WaitForAxis(Axis);
    return ReadBit(SWITCHES + Axis) == Level;
}

void Home(int Axis)
{
    if (!JogUntil(Axis, Towards[Axis], 1) || !JogUntil(Axis, -0.05 * Towards[Axis], 0))
    {
        printf("%c: no switch\n", 'X' + Axis);
        return;
    }
    Zero(Axis);
    persist.UserData[FLAGS] &= ~(1 << Axis);
    printf("%c is home, flags %d\n", 'X' + Axis, persist.UserData[FLAGS]);
}

main()
{
    int i, Wanted = persist.UserData[FLAGS];

    // Z first: the tool out of the way.
    for (i = 2; i >= 0; i--)
    {
        if (Wanted & 1 << i)
        {
            SetupStepAxis(i, 20000.0f, 200000.0f, 4e6f);
            Home(i);
        }
    }
}
