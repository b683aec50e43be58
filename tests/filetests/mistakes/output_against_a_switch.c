//@ args: --machine parts/home.toml
//@ says: thread 1 at output_against_a_switch.c:7:5 in `main`: SetBitDirection(12, 1): the machine drives bit 12, so two outputs drive the same pin, and the program can no longer read the input
#include "KMotionDef.h"

main()
{
    SetBitDirection(12, 1);
}
