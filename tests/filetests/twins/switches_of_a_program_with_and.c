//@ prints: simulated
#include "KMotionDef.h"

#define SIMULATE 1
#define TRACE 0

main()
{
    int n = 3;
    if (SIMULATE && n > 2) printf("simulated\n");
    if (TRACE || n == 4) printf("traced\n");
    while (1 && n > 0) n--;
}
