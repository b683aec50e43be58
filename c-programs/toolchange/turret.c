// cc67: run --set persist.30=4
//
// turret.c - a lathe turret that turns forward over its pawl and is locked by turning back.
//
//   cc67 run --stim c-programs/toolchange/turret.stim c-programs/toolchange/turret.c --set persist.30=4
//
// Three bits tell the face. They do not change all at the same instant, so a number
// counts only when it was read twice, with some time in between. The motor must not be
// reversed at once; and pressed against the pawl it may stay under current for a short
// time only.
//
// Expect the faces 1, 2, 3, 4 as they come by, and the turret locked.

#include "KMotionDef.h"

#define WANTED_VAR 30               // persist
#define CODE_BITS  140              // the lowest of three
#define LOCKED     143
#define FORWARD    154
#define BACKWARD   155
#define FACES      4
#define SETTLE     0.01             // seconds between two readings
#define TIME_OUT   3.0

int ReadCode(void)
{
    return ReadBit(CODE_BITS) + 2 * ReadBit(CODE_BITS + 1) + 4 * ReadBit(CODE_BITS + 2);
}

// The face, read until two readings agree.
int Face(void)
{
    int First, Second = ReadCode();

    do
    {
        First = Second;
        Delay_sec(SETTLE);
        Second = ReadCode();
    }
    while (First != Second);
    return Second;
}

// Turns forward until a face is there. FALSE: it never came.
int TurnTo(int Wanted)
{
    double Limit = Time_sec() + TIME_OUT;
    int Now = Face(), Last = 0;

    SetBit(FORWARD);
    while (Now != Wanted && Time_sec() < Limit)
    {
        if (Now != Last) printf("face %d\n", Now);
        Last = Now;
        Now = Face();
    }
    ClearBit(FORWARD);
    return Now == Wanted;
}

int Lock(void)
{
    double Limit;

    Delay_sec(0.1);                 // the motor comes to rest
    SetBit(BACKWARD);
    Limit = Time_sec() + 0.5;
    while (!ReadBit(LOCKED) && Time_sec() < Limit) WaitNextTimeSlice();
    Delay_sec(0.05);
    ClearBit(BACKWARD);
    return ReadBit(LOCKED);
}

main()
{
    int Wanted = persist.UserData[WANTED_VAR];

    if (Wanted < 1 || Wanted > FACES) printf("there is no face %d\n", Wanted);
    else if (!TurnTo(Wanted)) printf("face %d never came\n", Wanted);
    else printf("face %d, %s\n", Wanted, Lock() ? "locked" : "NOT LOCKED");
}
