// A project that was written on Windows: backslashes, folders upwards, names in another letter case.
//@ prints: requested 5 at 2.500000
#include "kmotiondef.h"
#include "parts\PcRequests.c"
//~^ note-if-case-matters: pcrequests.c
#include "..\habits\parts\machine.h"

main()
{
    RequestSpeed(SPINDLE_CODE, 2.5);
    printf("requested %d at %f\n", persist.UserData[REQUEST_AT], *(float *)&persist.UserData[REQUEST_AT + 1]);
}
//@ cycles: 9478
