//@ args: --set board.snapamp=1
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->InputChan0 = 8;
    ch0->OutputMode = DC_SERVO_MODE;
    ch0->OutputChan0 = 8;
    EnableAxis(0);
}
