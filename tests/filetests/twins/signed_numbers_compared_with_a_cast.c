//@ prints: small few
#include "KMotionDef.h"

main()
{
    unsigned limit = 100;
    int error = -5, count = 3;
    if (error < (int)limit) printf("small ");
    if ((unsigned)error < limit) printf("in range ");
    if (count < limit) printf("few\n");
}
