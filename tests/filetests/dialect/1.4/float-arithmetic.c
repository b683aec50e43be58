//@ prints: 0 1 1 0
//@ prints: 16777216 16777217
//@ prints: 1 1 1
#include "KMotionDef.h"

float f = 0.1f, big = 16777216.0f, one = 1.0f, three = 3.0f;
static double folded_float = 16777216.0f + 1.0f, folded_double = 16777216.0f + 1.0;
static double third = 1.0f / 3.0f;
enum { SAME = 0.1f == 0.1, LESS = 0.1f < 0.1 };

main()
{
    double in_float = one / three;
    printf("%d %d %d %d\n", f == 0.1, f == 0.1f, 16777216.0f + 1.0f == 16777216.0f, SAME); //~ float-equality
    printf("%.0f %.0f\n", big + one, big + 1.0);
    printf("%d %d %d\n", folded_float == big + one, folded_double == big + 1.0, third == in_float);
}
//@ cycles: 34674
