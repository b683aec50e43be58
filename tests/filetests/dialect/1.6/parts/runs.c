// Says what earlier runs of the same image left behind.
#include "KMotionDef.h"

int initialised = 5, uninitialised;

main()
{
    static int runs;
    if (!persist.UserData[50]) return;
    runs++;
    printf("initialised %d, uninitialised %d, static %d\n", initialised++, uninitialised++, runs);
    persist.UserData[50] = 0;
}
