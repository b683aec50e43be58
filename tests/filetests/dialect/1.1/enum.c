//@ prints: 4 -1 12345 1
#include "KMotionDef.h"

enum Side { LEFT = -1, RIGHT = 1 };
enum Side side = LEFT;

main()
{
    int before;
    before = side;
    side = 12345;
    printf("%d %d %d %d\n", sizeof(enum Side), before, side, (enum Side)-2 < RIGHT);
}
//@ cycles: 9969
