// Sends three axes back and forth, then computes beside them like the others.

#include "KMotionDef.h"

static void setup(int axis)
{
    CHAN *ch = &chan[axis];

    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = NO_OUTPUT_MODE;
    ch->Vel = 40000;
    ch->Accel = 400000;
    ch->Jerk = 4000000;
    ch->MaxFollowingError = 1e9;
    EnableAxisDest(axis, 0);
}

int main(void)
{
    int axis, way = 1;
    double sum = 0;

    for (axis = 0; axis < 3; axis++)
        setup(axis);
    for (;;) {
        for (axis = 0; axis < 3; axis++)
            if (CheckDone(axis))
                Move(axis, way * (30000 + 1000 * axis));
        way = -way;
        for (axis = 0; axis < 20000; axis++)
            sum = 0.5 * sum + axis;
    }
}
