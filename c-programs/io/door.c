// cc67: run
//
// door.c - an open door holds the axes; closed again, a button lets them continue.
//
//   cc67 run --stim c-programs/io/door.stim c-programs/io/door.c
//
// The hold is a feedhold: the axes come to rest within their acceleration and lose
// nothing. Closing the door is not enough, because somebody may stand inside: it takes
// the button as well.
//
// The file beside this program is the operator. Expect a hold, a button that is pressed
// too early, and the end of the move.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define DOOR_CLOSED 136
#define BUTTON      137
#define MOVING      0               // CS0_StoppingState: nobody holds

int IsHeld;
int ButtonBefore;

void ServiceDoor(void)
{
    int Button = ReadBit(BUTTON), Pressed = Button && !ButtonBefore;

    ButtonBefore = Button;
    if (!IsHeld && !ReadBit(DOOR_CLOSED))
    {
        StopCoordinatedMotion();
        IsHeld = TRUE;
        printf("%.1f s: door open, hold\n", Time_sec());
    }
    else if (IsHeld && Pressed)
    {
        if (!ReadBit(DOOR_CLOSED))
        {
            printf("%.1f s: button, but the door is open\n", Time_sec());
            return;
        }
        ResumeCoordinatedMotion();
        IsHeld = FALSE;
        printf("%.1f s: going on\n", Time_sec());
    }
}

main()
{
    SetupStepAxis(0, 10000.0f, 100000.0f, 1e6f);
    SetupStepAxis(1, 10000.0f, 100000.0f, 1e6f);
    DefineCoordSystem(0, 1, -1, -1);
    IsHeld = ButtonBefore = FALSE;

    Move(0, 10000.0);
    while (IsHeld || CS0_StoppingState != MOVING || !CheckDone(0))
    {
        WaitNextTimeSlice();
        UpdateStoppingState();
        ServiceDoor();
    }
    printf("X %.0f\n", chan[0].Dest);
}
