//@ args: --machine parts/carousel.toml
//@ prints: 1
#include "KMotionDef.h"

main()
{
    ch5->InputMode = ENCODER_MODE;
    ch5->InputChan0 = 5;
    SetBit(152);
    while (!ReadBit(136)) WaitNextTimeSlice();
    ClearBit(152);
    Delay_sec(0.5);
    printf("%d\n", ch5->Position > 990 && ch5->Position < 1020);
}
