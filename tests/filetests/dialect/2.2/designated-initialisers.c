//@ prints: 0 7 0 9 5
//@ prints: 3 4 8 8 0 2
#include "KMotionDef.h"

struct Point { int x, y; };
int sparse[] = { [1] = 7, [3] = 9, 5 };
struct Point gnu = { y: 4, x: 3 };
int range[4] = { [0 ... 2] = 8 };
int none[2] = {};

main()
{
    struct Point *p = &(struct Point){ 1, 2 };
    printf("%d %d %d %d %d\n", sparse[0], sparse[1], sparse[2], sparse[3], sparse[4]);
    printf("%d %d %d %d %d %d\n", gnu.x, gnu.y, range[0], range[2], range[3] + none[1], p->y);
}
//@ cycles: 23593
