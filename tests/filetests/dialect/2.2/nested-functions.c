//@ exit: 1
#include "KMotionDef.h"

main()
{
    int inner(int n) { return n; } //~ error: function
    inner(3);
}
