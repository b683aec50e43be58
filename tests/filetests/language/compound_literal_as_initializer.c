// An object is filled from a compound literal of its type: static objects too, arrays and nested parts.
//@ prints: 1 2 3 0
//@ prints: 5 6 7 8
//@ prints: 3 30 2 9
#include "KMotionDef.h"

typedef struct { int x, y; } Point;
typedef struct { Point from, to; } Path;

Point here = (Point){ 1, 2 };
Path path = { (Point){ 3 }, .to = (Point){ .y = 7, .x = 6 } };
int list[] = (int[]){ 10, 20, 30 };
Point *corner = &(Point){ 8, 9 };

main()
{
    static Path still = (Path){ { 5, 6 }, { 7, 8 } };
    Point local = (Point){ 2, 9 };
    printf("%d %d %d %d\n", here.x, here.y, path.from.x, path.from.y);
    printf("%d %d %d %d\n", still.from.x, still.from.y, still.to.x, corner->x);
    printf("%d %d %d %d\n", sizeof(list) / sizeof(list[0]), list[2], local.x, local.y);
}
//@ cycles: 26347
