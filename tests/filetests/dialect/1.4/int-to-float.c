//@ prints: 16777216 16777220 2147483648 -16777216
//@ prints: 16777216 16777220 2147483648 -16777216
#include "KMotionDef.h"

int odd = 16777217, three = 16777219, most = 2147483647, minus = -16777217;
static float a = 16777217, b = 16777219, c = 2147483647, d = -16777217;

main()
{
    printf("%.0f %.0f %.0f %.0f\n", (float)odd, (float)three, (float)most, (float)minus);
    printf("%.0f %.0f %.0f %.0f\n", a, b, c, d);
}
//@ cycles: 80499
