// The slip of an old helper: the comparison is assigned, and the loop ends all the same.
//@ prints: waited 3 times, result 0
#include "KMotionDef.h"

int Left = 3;

int Ask()
{
    return --Left;
}

main()
{
    int result, waited = 0;
    do
    {
        waited++;
    }
    while (result = Ask() > 0); //~ assignment-condition
    printf("waited %d times, result %d\n", waited, result);
}
//@ cycles: 8495
