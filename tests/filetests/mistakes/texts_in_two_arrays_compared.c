//@ args: check
//@ says: warning[text-comparison]: two addresses are compared, not two texts
//@ says: texts_in_two_arrays_compared.c:10:9
#include "KMotionDef.h"

char wanted[8] = "X", found[8] = "X";

main()
{
    if (wanted != found) printf("another axis\n");
}
