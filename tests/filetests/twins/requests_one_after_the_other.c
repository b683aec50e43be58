//@ args: check
// Each request is read before the next one is sent.
#include "KMotionDef.h"

void Text(char *text)
{
    sprintf((char *)gather_buffer, text);
    persist.UserData[101] = 0;
}

void Mdi(char *text)
{
    Text(text);
    persist.UserData[100] = PC_COMM_MDI;
    while (persist.UserData[100] > 0) WaitNextTimeSlice();
}

void Halt(void)
{
    persist.UserData[100] = PC_COMM_HALT;
}

main()
{
    Mdi("M5");
    Mdi("G0 X0 Y200");
    if (ReadBit(136)) Halt();
    else persist.UserData[100] = PC_COMM_ESTOP;
    Delay_sec(1);
    Halt();
}
