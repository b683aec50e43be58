// cc67: run
//
// index.c - homing to a switch, and from there to the index pulse of the encoder.
//
//   cc67 run --machine c-programs/homing/index.toml c-programs/homing/index.c
//
// A switch opens a little earlier or later from day to day; the index pulse does not. The
// axis runs to the switch, off it again, and then slowly on to the next pulse: that is
// zero. The machine file beside this program has a pulse at every 4000 counts.
//
// The way from the switch to the pulse is printed, because it warns: close to nothing, or
// to a whole turn, the switch may one day open on the other side of a pulse.
//
// Expect a way of 1300 counts, and X waiting at 2000.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define AXIS        0
#define HOME_SWITCH 136
#define INDEX_BIT   36
#define TURN        4000.0

// Jogs until a bit has a level, and tells where that was.
double JogUntil(double Speed, int Bit, int Level)
{
    double Where;

    Jog(AXIS, Speed);
    while (ReadBit(Bit) != Level) WaitNextTimeSlice();
    Where = chan[AXIS].Dest;
    Jog(AXIS, 0.0);
    WaitForAxis(AXIS);
    return Where;
}

main()
{
    double Switch, Index, Way;

    SetupStepAxis(AXIS, 20000.0f, 200000.0f, 4e6f);

    JogUntil(-8000.0, HOME_SWITCH, 1);
    Switch = JogUntil(500.0, HOME_SWITCH, 0);
    Index = JogUntil(500.0, INDEX_BIT, 1);

    Way = Index - Switch;
    printf("%.0f counts from the switch to the index\n", Way);
    if (Way < 0.1 * TURN || Way > 0.9 * TURN) printf("move the switch by half a turn\n");

    MoveAtVel(AXIS, Index, 500.0f);
    WaitForAxis(AXIS);
    Zero(AXIS);
    Move(AXIS, 2000.0);
    WaitForAxis(AXIS);
    printf("X waits at %.0f\n", chan[AXIS].Dest);
}
