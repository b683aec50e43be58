//@ args: check
//@ says: warning[unused-label]: no `goto` names the label `defualt`
//@ says: default_misspelt.c:11:9
#include "KMotionDef.h"

main()
{
    switch (persist.UserData[20])
    {
        case 1: printf("one\n"); break;
        defualt: printf("another\n");
    }
}
