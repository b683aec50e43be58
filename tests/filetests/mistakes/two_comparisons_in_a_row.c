//@ args: check
//@ says: warning[precedence]: `<` compares a 0 or 1 here
//@ says: two_comparisons_in_a_row.c:8:9
//@ says: write both comparisons: `a < b && b < c`
#include "KMotionDef.h"
main()
{
    if (0 < ch0->Position < 500) SetBit(46);
    if (!CheckDone(0) == 5) SetBit(47);
    if ((0 < ch0->Position) == (ch1->Position < 500)) ClearBit(46);
}
