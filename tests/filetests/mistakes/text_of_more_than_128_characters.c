//@ prints: the carousel is at pocket 7, the spindle is stopped, the door is closed, the air pressure is good, and so the machine is read
//@ says: thread 1 at text_of_more_than_128_characters.c:9:5 in `main`: printf: this text has 131 characters, and the board takes 128 of a call: the rest is lost, and the end of the line with it; print it with several calls
#include "KMotionDef.h"

main()
{
    int i = 7;

    printf("the carousel is at pocket %d, the spindle is stopped, the door is closed, the air pressure is good, and so the machine is ready now\n", i);
}
