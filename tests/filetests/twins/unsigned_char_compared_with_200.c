//@ prints: full
#include "KMotionDef.h"

main()
{
    unsigned char level = 200;
    if (level == 200) printf("full\n");
}
