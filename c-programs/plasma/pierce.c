// cc67: run
//
// pierce.c - M3 of a plasma table: touch the sheet, rise, fire, wait for the arc, go down to cut.
//
//   cc67 run --machine c-programs/plasma/pierce.toml --stim c-programs/plasma/pierce.stim c-programs/plasma/pierce.c
//
// The height of the sheet is found by touching it. Pierced is from higher up, so that the
// melt does not hit the torch. The source tells when it has an arc; if there is none within
// a second the torch is switched off and fired again, three times at most. Then the job
// must stop, or the table would draw a cut that nobody cuts.
//
// Expect the sheet at -1850, one try without an arc, and Z at the cutting height.

#include "KMotionDef.h"
#include "../motion/step_axis.c"

#define Z            2
#define TOUCH        138            // the floating head
#define TORCH        152            // output
#define ARC_OK       136            // input
#define PIERCE       400.0          // steps above the sheet
#define CUT          150.0
#define PIERCE_TIME  0.6            // seconds
#define ARC_TIME     1.0
#define TRIES        3

double TouchOff(void)
{
    double Sheet;

    Jog(Z, -1000.0);
    while (!ReadBit(TOUCH)) WaitNextTimeSlice();
    Sheet = chan[Z].Dest;
    Jog(Z, 0.0);
    WaitForAxis(Z);
    return Sheet;
}

void MoveZ(double To)
{
    Move(Z, To);
    WaitForAxis(Z);
}

int Fire(void)
{
    double Limit = Time_sec() + ARC_TIME;

    SetBit(TORCH);
    while (!ReadBit(ARC_OK))
    {
        if (WaitNextTimeSlice() > Limit)
        {
            ClearBit(TORCH);
            return FALSE;
        }
    }
    return TRUE;
}

main()
{
    int Try;
    double Sheet;

    SetupStepAxis(Z, 10000.0f, 100000.0f, 4e6f);
    Sheet = TouchOff();
    printf("sheet at %.0f\n", Sheet);
    MoveZ(Sheet + PIERCE);

    for (Try = 1; Try <= TRIES; Try++)
    {
        if (Fire())
        {
            Delay_sec(PIERCE_TIME);
            MoveZ(Sheet + CUT);
            printf("cutting %.0f above the sheet\n", chan[Z].Dest - Sheet);
            return;
        }
        printf("try %d: no arc\n", Try);
        Delay_sec(0.5);
    }
    printf("no arc: the job is halted\n");
    persist.UserData[PC_COMM_PERSIST] = PC_COMM_HALT;
}
