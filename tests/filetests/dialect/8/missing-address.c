//@ args: check
#include "KMotionDef.h"

main()
{
    int n;
    double d = 0;
    sscanf("5", "%d", n); //~ missing-address: `%d` //~ uninitialized
    sscanf("5", "%lf", d); //~ missing-address: `%lf`
}
