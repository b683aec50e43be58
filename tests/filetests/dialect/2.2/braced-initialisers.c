//@ prints: 1 2 4 0 5 6
//@ prints: two X 6 0 0
//@ prints: 7 0 1.500000 0
#include "KMotionDef.h"

int nested[2][3] = { { 1, 2 }, { 4 } }, flat[2][2] = { 5, 6 };
char *names[] = { "one", "two" };
char text[4] = "X";
struct { int n; double x; int list[3]; } mixed = { 7, 1.5 };

dirty() { int filler[40]; int i; for (i = 0; i < 40; i++) filler[i] = -1; return filler[3]; }

main()
{
    dirty();
    int local[4] = { 6 };
    struct { int a; double b; } pair = { 7 };
    printf("%d %d %d %d %d %d\n", nested[0][0], nested[0][1], nested[1][0], nested[1][1], flat[0][0], flat[0][1]);
    printf("%s %s %d %d %d\n", names[1], text, local[0], local[1], local[3]);
    printf("%d %.0f %f %d\n", pair.a, pair.b, mixed.x, mixed.list[2]);
}
//@ cycles: 35063
