//@ exit: 1
#include "KMotionDef.h"

double d = 5;

main()
{
    int a;
    a = d % 2; //~ error: `%`
    a = d & 2; //~ error: `&`
    a = d | 2; //~ error: `|`
    a = d ^ 2; //~ error: `^`
    a = ~d; //~ error: `~`
    a = d << 2; //~ error: `<<`
}
