//@ prints: 44 300 65535 1 255
#include "KMotionDef.h"

unsigned char a = 200, b = 100, c;
unsigned short s; //~ redeclared

main()
{
    c = a + b;
    s = -1;
    printf("%d %d %d %d ", c, a + b, s, s > -1);  //~ constant-comparison
    c = 0;
    c--;
    printf("%d\n", c);
}
//@ cycles: 13694
