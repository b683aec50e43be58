//@ args: check
//@ says: warning[constant-comparison]: this comparison is always false
//@ says: byte_of_a_frame_in_an_int.c:9:9
#include "KMotionDef.h"

main()
{
    int reply = RS232_GetChar();
    if (reply == 0x83) printf("refused\n");
}
