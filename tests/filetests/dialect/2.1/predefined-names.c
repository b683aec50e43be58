//@ prints: predefined-names.c 8 main main
//@ prints: Jan  1 2000 00:00:00
#include "KMotionDef.h"

main()
{
    /* Where the file is must not change what is printed, nor the time that it takes. */
    printf("%s %d %s %s\n", __FILE__ + sizeof __FILE__ - sizeof "predefined-names.c", __LINE__, __func__, __FUNCTION__);
    printf("%s %s\n", __DATE__, __TIME__);
}
//@ cycles: 17682
