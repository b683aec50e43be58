//@ prints: seen
#include "KMotionDef.h"

double executed;

void note(void) { if (ServoTick > 1000.0) executed = ServoTick; }

main()
{
    UserCallBack = note;
    while (executed == 0.0) ;
    UserCallBack = 0;
    printf("seen\n");
}
//@ cycles: 8017859
