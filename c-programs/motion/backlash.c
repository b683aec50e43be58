// cc67: run
//
// backlash.c - taking up the play of a screw when the direction changes.
//
//   cc67 run c-programs/motion/backlash.c
//
// With the compensation on, the board drives further by the amount of the play whenever
// the axis turns round, at the rate that is given. The position that programs and the PC
// see does not contain it.
//
// Expect 12 steps in one direction, none in the other, at the same positions.

#include "KMotionDef.h"
#include "step_axis.c"

#define AXIS 0
#define PLAY 12.0f                  // steps

void MoveAndShow(double To)
{
    Move(AXIS, To);
    WaitForAxis(AXIS);
    Delay_sec(0.1);                 // the rest of the play
    printf("at %5.0f: %4.1f steps of play taken up\n", chan[AXIS].Dest, chan[AXIS].Backlash);
}

main()
{
    SetupStepAxis(AXIS, 10000.0f, 100000.0f, 1e6f);
    chan[AXIS].BacklashMode = BACKLASH_LINEAR;
    chan[AXIS].BacklashAmount = PLAY;
    chan[AXIS].BacklashRate = 400.0f;       // steps a second

    MoveAndShow(1000.0);
    MoveAndShow(500.0);
    MoveAndShow(0.0);
    MoveAndShow(500.0);
}
