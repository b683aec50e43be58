//@ prints: inside outside alternative
#include "KMotionDef.h"

main()
{
    int mode = 5;
    double place = 2.5;
    if (mode > 1 && mode < 9) printf("inside ");
    if (place < 1 || place > 2) printf("outside ");
    if (mode == 4 || mode == 5) printf("alternative\n");
    if (mode != 5 && mode != 6) printf("neither\n");
}
