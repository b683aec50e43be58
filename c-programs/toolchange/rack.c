// cc67: run --set persist.31=2 --set persist.30=3
//
// rack.c - a row of forks at the end of the table: where the tools are follows from a table.
//
//   cc67 run --stim c-programs/toolchange/rack.stim c-programs/toolchange/rack.c --set persist.31=2 --set persist.30=3
//
// The spindle slides into a fork from the side, lets its tool go, rises, slides into the
// next one, and comes out with another tool. Before anything moves, the switches in the
// forks must agree with what the program believes: the fork of the tool in the spindle
// empty, that of the requested one full.
//
// Expect the way over both forks, and tool 3.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define WANTED_VAR 30               // persist: from the PC
#define TOOL_VAR   31               // persist: in the spindle
#define TOOLS      4
#define TOOL_SEEN  135              // + number of the tool: one is in the fork
#define COLLET     152              // air opens the collet

#define ASIDE      1500.0           // Y in front of the forks
#define UP         0.0
#define DOWN       (-3000.0)

double ForkX[TOOLS + 1] = { 0.0, 1000.0, 3000.0, 5000.0, 7000.0 };
double ForkY = 4000.0;

void GoTo(double X, double Y, double Z)
{
    Move(0, X);
    Move(1, Y);
    WaitForAxis(0);
    WaitForAxis(1);
    Move(2, Z);
    WaitForAxis(2);
    printf("X %5.0f Y %5.0f Z %5.0f\n", chan[0].Dest, chan[1].Dest, chan[2].Dest);
}

void Collet(int Open)
{
    SetStateBit(COLLET, Open);
    Delay_sec(0.3);
}

void PutAway(int Tool)
{
    GoTo(ForkX[Tool], ForkY - ASIDE, DOWN);
    GoTo(ForkX[Tool], ForkY, DOWN);         // into the fork from the side
    Collet(TRUE);
    GoTo(ForkX[Tool], ForkY, UP);
}

void Take(int Tool)
{
    GoTo(ForkX[Tool], ForkY, UP);
    GoTo(ForkX[Tool], ForkY, DOWN);
    Collet(FALSE);
    GoTo(ForkX[Tool], ForkY - ASIDE, DOWN); // out of it to the side
    GoTo(ForkX[Tool], ForkY - ASIDE, UP);
}

int AsBelieved(int Old, int New)
{
    if (ReadBit(TOOL_SEEN + Old)) printf("fork %d is not empty\n", Old);
    else if (!ReadBit(TOOL_SEEN + New)) printf("fork %d is empty\n", New);
    else return TRUE;
    return FALSE;
}

main()
{
    int i, Old = persist.UserData[TOOL_VAR], New = persist.UserData[WANTED_VAR];

    for (i = 0; i < 3; i++) SetupStepAxis(i, 20000.0f, 200000.0f, 4e6f);
    if (!AsBelieved(Old, New)) return;
    PutAway(Old);
    Take(New);
    persist.UserData[TOOL_VAR] = New;
    printf("tool %d\n", New);
}
