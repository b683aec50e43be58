//@ args: check
//@ says: warning[lost-swap]: `table[i+1]` gets its own value back: the value of `table[i]` is lost
//@ says: swap_of_two_elements.c:16:17
#include "KMotionDef.h"

int table[5] = { 5, 3, 4, 1, 2 };

main()
{
    int i, k;
    for (k = 0; k < 5; k++)
        for (i = 0; i < 4; i++)
            if (table[i] > table[i + 1])
            {
                table[i] = table[i + 1];
                table[i + 1] = table[i];
            }
    for (i = 0; i < 5; i++) printf("%d\n", table[i]);
}
