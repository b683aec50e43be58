//@ exit: 1
#include "KMotionDef.h"
#define TWO(a, b) (a 0 + b 0)

main()
{
    int a = TWO(,);
    a = TWO(1, 2, 3); //~ error: TWO
    a = TWO(1); //~ error: TWO
}
