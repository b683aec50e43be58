//@ prints: 123 4 3.4 15 3
#include "KMotionDef.h"

main()
{
    int seconds = 7384, n = 17;
    double minutes = seconds / 60, rest = seconds % 60, exact = (double)n / 5;
    int whole = n / 5;
    double grid = n / 5 * 5, kept = whole;
    printf("%g %g %g %g %g\n", minutes, rest, exact, grid, kept);
}
