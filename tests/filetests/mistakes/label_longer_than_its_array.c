//@ prints: spindle turns at 1200.500000 rpm
//@ says: thread 1 at label_longer_than_its_array.c:10:5 in `main`: sprintf stores 33 bytes in `line`, which has 16: the memory after it is overwritten
#include "KMotionDef.h"

char line[16];

main()
{
    double rpm = 1200.5;
    sprintf(line, "spindle turns at %f rpm", rpm);
    printf("%s\n", line);
}
