// Switches its call-back on or off, from run to run.
#include "KMotionDef.h"

int Installed = FALSE;

void Work(void)
{
    persist.UserData[81]++;
}

main()
{
    if (!persist.UserData[80]) return;
    Installed = !Installed;
    UserCallBack = Installed ? Work : NULL;
    if (Installed) printf("on\n");
    else printf("off\n");
    persist.UserData[80] = 0;
}
