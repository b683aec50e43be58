//@ args: check
//@ says: warning[stale-position]: `ch2->Position` does not follow axis 2, which has no input
//@ says: position_of_a_stepper_without_an_encoder.c:22:15
#include "KMotionDef.h"

void Setup(int axis, float speed)
{
    CHAN *ch = &chan[axis];
    ch->InputMode = NO_INPUT_MODE;
    ch->OutputMode = STEP_DIR_MODE;
    ch->OutputChan0 = 8 + axis;
    ch->Vel = speed;
    EnableAxisDest(axis, 0);
}

main()
{
    double touched;
    Setup(2, 8000);
    Jog(2, -1000);
    while (!ReadBit(139)) WaitNextTimeSlice();
    touched = ch2->Position;
    Jog(2, 0);
    printf("plate at %.1f\n", touched);
}
