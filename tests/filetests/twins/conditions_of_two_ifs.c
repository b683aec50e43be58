//@ prints: first
//@ prints: again
#include "KMotionDef.h"

main()
{
    int key = persist.UserData[20];
    if (key == 0) printf("first\n");
    else if (key == 1) printf("second\n");
    if (key == 0) printf("again\n");
}
