//@ args: check
//@ says: warning[shadow]: this `state` shadows the global `state`
//@ says: global_hidden_by_a_local.c:10:9
#include "KMotionDef.h"

int state = 0;

void Begin(void)
{
    int state = 5;
}

main()
{
    Begin();
    printf("%d\n", state);
}
