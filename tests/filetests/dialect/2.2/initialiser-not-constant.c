//@ exit: 1
#include "KMotionDef.h"

int n = 5;
int a = n; //~ error: constant
double t = Time_sec(); //~ error: constant
double v = ch0->Vel; //~ error: constant

main() { }
