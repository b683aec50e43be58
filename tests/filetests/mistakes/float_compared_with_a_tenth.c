//@ args: check
//@ says: warning[float-equality]: no `float` is 0.1
//@ says: float_compared_with_a_tenth.c:9:9
#include "KMotionDef.h"

main()
{
    float pitch = 0.1;
    if (pitch == 0.1) printf("metric\n");
}
