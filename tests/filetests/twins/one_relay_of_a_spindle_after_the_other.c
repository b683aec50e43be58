//@ args: --machine ../mistakes/parts/relay_spindle.toml
#include "KMotionDef.h"

main()
{
    SetBit(154);
    Delay_sec(1);
    ClearBit(154);
    Delay_sec(0.1);
    SetBit(155);
}
