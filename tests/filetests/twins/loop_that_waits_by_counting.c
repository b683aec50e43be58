//@ prints: 3
#include "KMotionDef.h"

main()
{
    int i, sum = 0;
    for (i = 0; i < 1000; i++) ;
    for (i = 0; i < 3; i++) sum += i;
    printf("%d\n", sum);
}
