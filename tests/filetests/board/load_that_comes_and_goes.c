//@ args: --machine parts/cut.toml --stim parts/cut.stim
//@ prints: 200 150 200
#include "KMotionDef.h"

double Speed(void)
{
    double before = ch0->Position;
    Delay_sec(0.1);
    return (ch0->Position - before) / 0.1;
}

main()
{
    double free, cut, after;
    ch0->InputMode = ENCODER_MODE;
    DAC(0, 200);
    Delay_sec(0.5);
    free = Speed();
    Delay_sec(0.5);
    cut = Speed();
    Delay_sec(0.5);
    after = Speed();
    DAC(0, 0);
    printf("%.0f %.0f %.0f\n", free / 10, cut / 10, after / 10);
}
