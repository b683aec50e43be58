// cc67: run
//
// orient.c - turning a spindle to one angle, as M19 does, for a tool changer with keys.
//
//   cc67 run --machine c-programs/spindle/orient.toml c-programs/spindle/orient.c
//
// Slowly on until the index pulse of the encoder comes, once a turn; from there the angle
// of the keys is a move. The pulse is 8 counts wide: at 1000 counts a second it is there
// for 8 ms, and a program that looks in every slice cannot miss it.
//
// Expect the index within a turn, and the keys a quarter of a turn after it.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define SPINDLE   6
#define INDEX_BIT 36
#define TURN      4096.0
#define KEYS      (TURN / 4.0)      // counts after the index
#define SEARCH    1000.0            // counts a second

// FALSE: a turn and a half without a pulse.
int FindIndex(void)
{
    double Start = chan[SPINDLE].Dest;

    Jog(SPINDLE, SEARCH);
    while (!ReadBit(INDEX_BIT))
    {
        WaitNextTimeSlice();
        if (chan[SPINDLE].Dest - Start > 1.5 * TURN) return FALSE;
    }
    return TRUE;
}

main()
{
    double Index;

    SetupStepAxis(SPINDLE, 20000.0f, 100000.0f, 1e6f);
    if (!FindIndex())
    {
        Jog(SPINDLE, 0.0);
        printf("no index pulse: is the encoder connected?\n");
        return;
    }
    Index = chan[SPINDLE].Dest;
    printf("index after %.2f turns\n", Index / TURN);
    MoveAtVel(SPINDLE, Index + KEYS, SEARCH);
    WaitForAxis(SPINDLE);
    printf("keys at %.0f degrees\n", 360.0 * (chan[SPINDLE].Dest - Index) / TURN);
}
