//@ args: check
//@ says: warning[octal]: `045` is octal and means 37
//@ says: bit_number_with_a_leading_zero.c:8:21
#include "KMotionDef.h"

main()
{
    SetBitDirection(045, 1);
}
