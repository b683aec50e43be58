// cc67: run
//
// following_error.c - how the board protects an axis whose motor does not follow.
//
//   cc67 run c-programs/motion/following_error.c
//
// The program itself plays the encoder (USER_INPUT_MODE): it lets the motor follow
// for a while and then get stuck. When the difference between where the axis should
// be and where it is exceeds MaxFollowingError, the board disables the axis and says
// so on the console.
//
// Expect the board's own message and an axis that is no longer enabled.

#include "KMotionDef.h"

#define AXIS  0
#define STUCK 500.0         // the motor does not get beyond this position

main()
{
    CHAN *ch = &chan[AXIS];

    ch->InputMode = USER_INPUT_MODE;
    ch->OutputMode = NO_OUTPUT_MODE;
    ch->Vel = 1000.0f;
    ch->Accel = 10000.0f;
    ch->Jerk = 100000.0f;
    ch->MaxFollowingError = 50.0;
    ch->Position = 0.0;
    EnableAxisDest(AXIS, 0.0);

    Move(AXIS, 2000.0);
    while (!CheckDone(AXIS))
    {
        WaitNextTimeSlice();
        if (ch->Dest < STUCK) ch->Position = ch->Dest;
    }

    printf("CheckDone %d, enabled %d\n", CheckDone(AXIS), ch->Enable);
    printf("the command was %s ahead of the motor\n",
           ch->Dest - ch->Position > 50.0 ? "more than 50" : "not far");
}
