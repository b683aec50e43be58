//@ prints: 0 0.000000 0 0
#include "KMotionDef.h"

number() { persist.UserData[0] = 7; } //~ missing-return: number
double real() { number(); } //~ missing-return: real
int *pointer() { number(); } //~ missing-return: pointer
early(int n) { if (n) return; return 5; }
unused() { number(); }

main()
{
    int a = number();
    double b = real();
    unused();
    printf("%d %f %d %d\n", a, b, (int)pointer(), early(1));
}
//@ cycles: 11187
