//@ args: check
//@ says: warning[vendor-parameter]: the vendor's compiler takes a wrong address for the parameter `value`
//@ says: address_of_a_parameter_passed_on.c:13:30
#include "KMotionDef.h"

int Peek(int *p)
{
    return *p;
}

void Send(int value)
{
    printf("sent %d\n", Peek(&value));
}

main()
{
    Send(111);
}
