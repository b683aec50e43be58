// cc67: part of bits.c
#include "KMotionDef.h"

main()
{
    Delay_sec(0.001);
    VirtualBits |= 0x8000;
    persist.UserData[21] = 1;
}
