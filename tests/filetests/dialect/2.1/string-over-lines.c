//@ prints: first
//@ prints: second
#include "KMotionDef.h"

main()
{
    printf("first
second\n");
//~^^ lax-text: string
}
