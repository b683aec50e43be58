#include "KMotionDef.h"

int m;

void Tock(void)
{
    m++;
}

main()
{
    Delay_sec(0.01);
    UserCallBack = Tock;
    Delay_sec(0.1);
    UserCallBack = 0;
}
