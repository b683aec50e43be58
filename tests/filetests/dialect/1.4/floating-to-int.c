//@ prints: 3 -3 2147483647 -2147483648 2147483647
//@ prints: 3 -3 2147483647 -2147483648 2147483647
//@ prints: 3 -3 2147483647
#include "KMotionDef.h"

double a = 3.99, b = -3.99, big = 1e10, zero = 0;
float f = 3e9f;
static int ca = 3.99, cb = (int)-3.99, cbig = (int)1e10, cminus = (int)-1e10, cnan = (int)(0.0 / 0.0); //~ lost-fraction
enum { A = (int)3.99, B = (int)-3.99, BIG = (int)3e9f };

main()
{
    printf("%d %d %d %d %d\n", (int)a, (int)b, (int)f, (int)-big, (int)(zero / zero));
    printf("%d %d %d %d %d\n", ca, cb, cbig, cminus, cnan);
    printf("%d %d %d\n", A, B, BIG);
}
//@ cycles: 46546
