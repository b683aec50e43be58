//@ args: --machine ../mistakes/parts/wired.toml
//@ prints: 1
#include "KMotionDef.h"

main()
{
    ch0->InputMode = ENCODER_MODE;
    DAC(0, 100);
    Delay_sec(1);
    DAC(0, 0);
    Delay_sec(0.5);
    printf("%d\n", ch0->Position > 900 && ch0->Position < 1100);
}
