//@ prints: 2 -32768 32768
#include "KMotionDef.h"

_Static_assert(sizeof(short) == 2 && _Alignof(short) == 2 && _Alignof(unsigned short) == 2, "short");

short s = 32768; //~ redeclared
unsigned short u = 32768;

main()
{
    printf("%d %d %d\n", sizeof s, s, u);
}
//@ cycles: 9013
