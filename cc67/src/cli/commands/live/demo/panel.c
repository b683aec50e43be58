// panel.c - the emergency stop of the demonstration, thread 2.

#include "KMotionDef.h"
#include "machine.h"

main()
{
    int i;

    for (;;)
    {
        while (!ReadBit(ESTOP)) WaitNextTimeSlice();
        PauseThread(1);
        for (i = 0; i < 3; i++) DisableAxis(i);
        ClearBit(SPINDLE);
        ClearBit(COOLANT);
        printf("emergency stop: release ESTOP to begin again\n");
        while (ReadBit(ESTOP)) WaitNextTimeSlice();
        StartThread(1);
    }
}
