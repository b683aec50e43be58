// following_error.c - the servo's message comes before what a program prints in the same slice.

#include "KMotionDef.h"

main()
{
    CHAN *ch = &chan[0];
    int i;

    for (i = 0; i < 2; i++)
    {
        ch->InputMode = USER_INPUT_MODE;
        ch->OutputMode = NO_OUTPUT_MODE;
        ch->Vel = 1000.0f;
        ch->Accel = 10000.0f;
        ch->Jerk = 100000.0f;
        ch->MaxFollowingError = 50.0;
        ch->Position = 0.0;
        EnableAxisDest(0, 0.0);
        Move(0, 2000.0);
        while (ch->Enable)
        {
            WaitNextTimeSlice();
            if (ch->Dest < 100.0) ch->Position = ch->Dest;
        }
        printf("disabled\n");
        printf("at %.0f\n", ch->Dest);
        Delay_sec(0.1);
    }
}
