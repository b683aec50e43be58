//@ prints: 5 0
#include "KMotionDef.h"

int a;
int a = 5;
int a;
double list[3];
double list[3];

main() { printf("%d %.0f\n", a, list[2]); }
//@ cycles: 5235
