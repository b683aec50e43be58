// Bytes from a buffer by a function that is void and returns them all the same.
//@ prints: 4F
//@ prints: 4B
//@ prints: end
#include "KMotionDef.h"

char Received[] = "OK";
int In = 0;

void GetByte()
{
    return Received[In++];
}

main()
{
    int c;
    printf("%X\n", GetByte()); //~ void-value
    c = GetByte(); //~ void-value
    printf("%X\n", c);
    if (!Received[In]) printf("end\n");
}
//@ cycles: 6576
