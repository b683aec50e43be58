//@ prints: position 12345
//@ says: thread 1 at text_longer_than_its_array.c:9:5 in `main`: sprintf stores 15 bytes in `text`, which has 8: the memory after it is overwritten
#include "KMotionDef.h"

char text[8];

main()
{
    sprintf(text, "position %d", 12345);
    printf("%s\n", text);
}
