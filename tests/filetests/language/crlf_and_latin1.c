// Lines end with CR LF, comments and strings hold latin-1 bytes.
//@ prints: cafÃ© ok
#include "KMotionDef.h"
#define OK 1 // größer
main()
{
    if (OK) printf("cafÃ© ok\n");
}