//@ args: check
//@ says: warning[precedence]: only the last of these 3 terms is divided by 3
//@ says: mean_without_parentheses.c:8:19
#include "KMotionDef.h"

main()
{
    double mean = ReadADC(0) + ReadADC(1) + ReadADC(2) / 3.0;
    printf("%f\n", mean);
}
