//@ says: thread 1 at two_axes_on_one_encoder.c:13:9 in `main`: EnableAxis: axis 1 reads encoder input 0, which axis 0 reads too: give each axis an InputChan0 of its own
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 2; i++)
    {
        chan[i].InputMode = ENCODER_MODE;
        chan[i].InputChan0 = 0;
        chan[i].OutputMode = DAC_SERVO_MODE;
        chan[i].OutputChan0 = i;
        EnableAxis(i);
    }
}
