//@ args: --machine ../mistakes/parts/spindle_on_dac.toml
#include "KMotionDef.h"

main()
{
    ch7->InputMode = ENCODER_MODE;
    ch7->OutputMode = DAC_SERVO_MODE;
    ch7->OutputChan0 = 0;
    ch7->P = 0.1;
    ch7->MaxOutput = 2047;
    EnableAxis(7);
}
