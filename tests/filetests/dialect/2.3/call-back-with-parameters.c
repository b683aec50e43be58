//@ exit: 1
#include "KMotionDef.h"

void with(int n) { persist.UserData[0] = n; }
int without() { return 0; }

main()
{
    UserCallBack = without;
    UserCallBack = with; //~ error: cannot convert
}
