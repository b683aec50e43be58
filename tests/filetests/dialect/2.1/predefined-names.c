//@ prints: predefined-names.c 6 main main 1
#include "KMotionDef.h"

main()
{
    printf("%s %d %s %s %d\n", __FILE__, __LINE__, __func__, __FUNCTION__, sizeof __DATE__ == 12 && sizeof __TIME__ == 9);
}
