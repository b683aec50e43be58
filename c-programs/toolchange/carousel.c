// cc67: run --set persist.30=5 --set persist.31=2
//
// carousel.c - M6 with a carousel of six pockets and a pneumatic drawbar.
//
//   cc67 run --stim c-programs/toolchange/carousel.stim c-programs/toolchange/carousel.c --set persist.30=5 --set persist.31=2
//
// The PC stores the requested slot and starts the program; which tool is in the spindle is
// kept in persist, so it survives the end of the program. The old tool goes back into its
// own pocket, the carousel turns on pocket by pocket, and the new tool is taken.
//
// Every step has its sensor and its time limit: a tool changer that continues blindly breaks
// something. When a step fails the job is halted and the changer left as it is.
//
// Expect tool 2 put away, three pockets counted, and tool 5 taken.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define WANTED_VAR  30              // persist: from the PC
#define TOOL_VAR    31              // persist: in the spindle, 0 for none
#define POCKETS     6

#define MOTOR       152             // turns the carousel
#define DRAWBAR     153             // air opens it
#define POCKET_SEEN 136             // a pulse for each pocket
#define OPEN_SEEN   137             // the drawbar is open

#define Z           2
#define Z_CLEAR     0.0             // above the tools
#define Z_CHANGE    (-4000.0)       // in the holder
#define STEP_TIME   1.0             // seconds for any one step

// Waits for a level. FALSE: it takes too long.
int WaitForBit(int Bit, int Level)
{
    double Limit = Time_sec() + STEP_TIME;

    while (ReadBit(Bit) != Level)
    {
        if (WaitNextTimeSlice() > Limit) return FALSE;
    }
    return TRUE;
}

int Drawbar(int Open)
{
    SetStateBit(DRAWBAR, Open);
    return WaitForBit(OPEN_SEEN, Open);
}

void MoveZ(double To)
{
    Move(Z, To);
    WaitForAxis(Z);
}

// Turns on until a pocket is under the spindle.
int TurnTo(int From, int To)
{
    int Count = (To - From + POCKETS) % POCKETS;

    while (Count-- > 0)
    {
        SetBit(MOTOR);
        if (!WaitForBit(POCKET_SEEN, 1)) return FALSE;
        ClearBit(MOTOR);
        if (!WaitForBit(POCKET_SEEN, 0)) return FALSE;
        From = From % POCKETS + 1;
        printf("pocket %d\n", From);
    }
    return TRUE;
}

int Exchange(int Old, int New)
{
    MoveZ(Z_CHANGE);
    if (!Drawbar(TRUE)) return FALSE;
    MoveZ(Z_CLEAR);
    if (Old) printf("tool %d put away\n", Old);
    persist.UserData[TOOL_VAR] = 0;

    if (!TurnTo(Old ? Old : 1, New)) return FALSE;

    MoveZ(Z_CHANGE);
    if (!Drawbar(FALSE)) return FALSE;
    MoveZ(Z_CLEAR);
    persist.UserData[TOOL_VAR] = New;
    return TRUE;
}

main()
{
    int New = persist.UserData[WANTED_VAR], Old = persist.UserData[TOOL_VAR];

    if (New == Old || New < 1 || New > POCKETS)
    {
        printf(New == Old ? "nothing to do\n" : "there is no such tool\n");
        return;
    }
    SetupStepAxis(Z, 20000.0f, 200000.0f, 4e6f);
    if (Exchange(Old, New))
    {
        printf("tool %d in the spindle\n", persist.UserData[TOOL_VAR]);
    }
    else
    {
        printf("the tool change has failed: clear it by hand\n");
        ClearBit(MOTOR);
        persist.UserData[PC_COMM_PERSIST] = PC_COMM_HALT;
    }
}
