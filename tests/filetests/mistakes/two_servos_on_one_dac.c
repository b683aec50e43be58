//@ says: thread 1 at two_servos_on_one_dac.c:13:9 in `main`: EnableAxis: axis 1 drives DAC 0, which axis 0 drives too: give each axis an OutputChan0 of its own
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 2; i++)
    {
        chan[i].InputMode = ENCODER_MODE;
        chan[i].InputChan0 = i;
        chan[i].OutputMode = DAC_SERVO_MODE;
        chan[i].OutputChan0 = 0;
        EnableAxis(i);
    }
}
