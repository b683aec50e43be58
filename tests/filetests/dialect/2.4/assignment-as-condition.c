//@ prints: 5 3
#include "KMotionDef.h"

main()
{
    int x = 0, n = 3, result;
    if (x = 5) printf("%d ", x); //~ assignment-condition
    do { n--; } while (result = n > 0); //~ assignment-condition
    if ((x = 3)) printf("%d\n", x);
}
//@ cycles: 4968
