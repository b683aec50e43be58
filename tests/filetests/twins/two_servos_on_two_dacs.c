#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 2; i++)
    {
        chan[i].InputMode = ENCODER_MODE;
        chan[i].InputChan0 = i;
        chan[i].OutputMode = DAC_SERVO_MODE;
        chan[i].OutputChan0 = i;
        EnableAxis(i);
    }
}
