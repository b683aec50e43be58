//@ prints: 1200 16 3 3000 19 1
#include "KMotionDef.h"

#define MM(x) ((x) * 200)
#define TWICE(x) 2 * x
#define HALF(x) x / 2
#define TRAVEL (1000 + 500)
#define SUM 10 + 5
#define IS_HIGH(x) x > 3 && x < 9

main()
{
    double a = 4, b = 2;
    int high = IS_HIGH(a + b) && b > 1;
    printf("%g %g %g %g %g %d\n", MM(a + b), TWICE(a * b), HALF(a) + HALF(b), 2.0 * TRAVEL, a + SUM, high);
}
