//@ prints: 7 8 c a d 9 b 1b 27 22 5c 3f 41 1f
#include "KMotionDef.h"

main()
{
    printf("%x %x %x %x %x %x %x %x %x %x %x %x %x %x\n", '\a', '\b', '\f', '\n', '\r', '\t', '\v', '\e', '\'', '\"',
           '\\', '\?', '\101', '\x1F');
}
//@ cycles: 30840
