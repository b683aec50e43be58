//@ args: check
//@ says: warning[power]: `^` is exclusive or, not a power
//@ says: square_written_with_a_caret.c:9:32
#include "KMotionDef.h"

main()
{
    int radius = persist.UserData[10];
    double area = 3.14159265 * (radius^2);
    printf("%f\n", area);
}
