//@ args: check
//@ says: warning[precedence]: `<` compares a 0 or 1 here
//@ says: range_negated.c:14:15
//@ says: `a < b && b < c`
#include "KMotionDef.h"

main()
{
    double error;

    do {
        WaitNextTimeSlice();
        error = ch0->Dest - ch0->Position;
    } while (!(-5 < error < 5));
    printf("clamped\n");
}
