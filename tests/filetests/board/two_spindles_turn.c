//@ args: --machine parts/two_spindles.toml
//@ prints: 20.00 -5.00
#include "KMotionDef.h"

main()
{
    double first, second;
    ch6->InputMode = ENCODER_MODE;
    ch7->InputMode = ENCODER_MODE;
    DAC(0, 2047);
    SetBit(155);
    Delay_sec(0.2);
    first = ch6->Position;
    second = ch7->Position;
    Delay_sec(1);
    printf("%.2f %.2f\n", (ch6->Position - first) / 1000, (ch7->Position - second) / 4000);
}
