//@ args: check
//@ says: warning[format]: `%s` needs a string
//@ says: letter_printed_as_a_text.c:10:25
//@ says: use `%c` for a character, `%d` for a number
#include "KMotionDef.h"

main()
{
    char letter = 'A';
    printf("axis %s\n", letter);
}
