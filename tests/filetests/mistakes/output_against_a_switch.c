//@ args: --machine parts/home.toml
//@ says: thread 1 at output_against_a_switch.c:7:5 in `main`: SetBitDirection(12, 1): the machine drives bit 12, so two outputs work against each other, and the program no longer sees the input
#include "KMotionDef.h"

main()
{
    SetBitDirection(12, 1);
}
