//@ prints: 4294967295 4294967296 3000000000
//@ prints: 4294967295 4294967296 3000000000
#include "KMotionDef.h"

unsigned all = -1, large = 3000000000u;
static double a = 4294967295u, c = 3000000000u;
static float b = 4294967295u;

main()
{
    printf("%.0f %.0f %.0f\n", (double)all, (float)all, 1.0 * large);
    printf("%.0f %.0f %.0f\n", a, b, c);
}
//@ cycles: 69920
