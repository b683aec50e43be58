//@ exit: 1
#include "KMotionDef.h"

main()
{
    printf("never closed);
}
//~^^ error: never closed
