//@ says: thread 1 at text_without_a_newline.c:6:5 in `main`: the text `done` has no newline: the board keeps it, and the PC never receives it
#include "KMotionDef.h"

main()
{
    printf("done");
}
