//@ prints: predefined-names.c 7 main main
//@ prints: Jan  1 2000 00:00:00
#include "KMotionDef.h"

main()
{
    printf("%s %d %s %s\n", __FILE__, __LINE__, __func__, __FUNCTION__);
    printf("%s %s\n", __DATE__, __TIME__);
}
