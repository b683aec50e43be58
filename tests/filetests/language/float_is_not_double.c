// `float op float` is computed in float; a double operand makes it double.
//@ prints: 0 1
//@ prints: 16777216 16777217
//@ prints: 1.100000023841858 1.1000000000000001
#include "KMotionDef.h"

float f = 0.1f, big = 16777216.0f;
double d = 0.1;

main()
{
    printf("%d %d\n", f == 0.1, f == 0.1f); //~ float-equality
    printf("%.0f %.0f\n", big + 1.0f, big + 1.0);
    printf("%.16g %.17g\n", 1.1f, 1.1);
}
//@ cycles: 38952
