//@ args: check
#include "KMotionDef.h"

main()
{
    int n;
    double d = 0;
    sscanf("5", "%d", n); //~ format //~ uninitialized
    sscanf("5", "%lf", d); //~ format
}
