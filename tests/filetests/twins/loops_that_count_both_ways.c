//@ prints: 4
#include "KMotionDef.h"

main()
{
    int i, sum = 0;
    double x;
    for (i = 0; i <= 7; i++) sum += i;
    for (i = 7; i > 0; i--) sum -= i;
    for (x = 1; x > 0.1; x -= 0.25) sum++;
    for (i = 0; i < persist.UserData[5]; i++) sum++;
    printf("%d\n", sum);
}
