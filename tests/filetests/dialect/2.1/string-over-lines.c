//@ prints: first
//@ prints: second
#include "KMotionDef.h"

main()
{
    printf("first
second\n");
//~^^ lax-text: string
}
//@ cycles: 2840
