//@ prints: own 3 7
#include "KMotionDef.h"

void SetBit(int bit) { printf("own %d ", bit); } //~ redeclared: SetBit
int s = 7; //~ redeclared

main()
{
    SetBit(3);
    printf("%d\n", s);
}
//@ cycles: 5714
