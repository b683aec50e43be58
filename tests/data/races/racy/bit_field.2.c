#include "KMotionDef.h"

struct state
{
    unsigned door : 1;
    unsigned tool : 7;
    unsigned mode : 4;
};

main()
{
    struct state *s = (struct state *)&persist.UserData[55];
    int i;

    for (i = 0; i < 2000; i++)
        s->tool = i;  // <-
}
