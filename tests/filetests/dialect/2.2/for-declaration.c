//@ prints: 10 7
#include "KMotionDef.h"

main()
{
    int i = 7, sum = 0;
    for (int i = 0; i < 5; i++) sum += i;
    printf("%d %d\n", sum, i);
}
//@ cycles: 4852
