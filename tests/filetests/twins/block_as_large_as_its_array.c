//@ prints: 0
#include <string.h>
#include "KMotionDef.h"

main()
{
    int values[10];
    memset(values, 0, sizeof(values));
    printf("%d\n", values[9]);
}
