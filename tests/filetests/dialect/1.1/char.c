//@ prints: 1 1 1 -56 -1 200
#include "KMotionDef.h"

_Static_assert(sizeof(char) == 1 && _Alignof(char) == 1, "char");
_Static_assert((char)200 == -56 && '\377' == -1, "plain char is signed");

char c = 200;
signed char s = '\377'; //~ redeclared
unsigned char u = 200;

main()
{
    printf("%d %d %d %d %d %d\n", sizeof c, sizeof s, sizeof u, c, s, u);
}
//@ cycles: 13986
