//@ prints: 0 2 -1 0 0 -1 2
//@ prints: 0 2 -1 0 0 -1 2
//@ prints: 0 2 -1 0
#include "KMotionDef.h"

int one = 1, minus = -7, by33 = 33, by65 = 65, by40 = 40, negative = -1, by_minus_63 = -63;
unsigned large = -7;
static int a = 1 << 33; //~ shift-count
static int b = 1 << 65; //~ shift-count
static int c = -7 >> 40; //~ shift-count
static unsigned d = (unsigned)-7 >> 40; //~ shift-count
static int e = 1 << -1; //~ shift-count
static int f = -7 >> -1; //~ shift-count
static int g = 1 << -63; //~ shift-count
enum {
    A = 1 << 33, //~ shift-count
    B = 1 << 65, //~ shift-count
    C = -7 >> 40, //~ shift-count
    D = (unsigned)-7 >> 40 //~ shift-count
};

main()
{
    printf("%d %d %d %d %d %d %d\n", one << by33, one << by65, minus >> by40, large >> by40, one << negative,
           minus >> negative, one << by_minus_63);
    printf("%d %d %d %d %d %d %d\n", a, b, c, d, e, f, g);
    printf("%d %d %d %d\n", A, B, C, D);
}
//@ cycles: 39295
