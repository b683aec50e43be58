//@ exit: 1
#include "KMotionDef.h"

int add(int a, int b) { return a + b; }

main()
{
    add(1); //~ error: argument
    add(1, 2, 3); //~ error: argument
    Move(0); //~ error: argument
}
