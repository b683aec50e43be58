// The program that the helper belongs to; it includes the header once more.
//@ prints: waiting
//@ prints: all off
#include "KMotionDef.h"
#include "estop_functions.c"

main()
{
    int i;
    printf("waiting\n");
    for (i = 0; i < 5; i++)
    {
        if (i == 3) SetBit(ESTOP_BIT);
        if (EStopPressed())
        {
            AllOff();
            break;
        }
        Delay_sec(0.01);
    }
    ClearBit(ESTOP_BIT);
}
//@ cycles: 6917
