// Functions take the axis structure by pointer; an array of records describes the machine.
//@ prints: X: 100 counts/mm, dest 1250
//@ prints: Z: 400 counts/mm, dest -2000
#include "KMotionDef.h"
#include "parts/machine.h"

typedef struct
{
    char *name;
    int axis;
    double counts;
    double home;
} AXIS;

AXIS Machine[2] = { { "X", X_AXIS, 100.0, 12.5 }, { "Z", Z_AXIS, 400.0, -5 } };

void SetHome(CHAN *ch, double at)
{
    ch->InputMode = NO_INPUT_MODE;
    ch->Dest = at;
}

main()
{
    AXIS *a;
    for (a = Machine; a < Machine + 2; a++)
    {
        SetHome(&chan[a->axis], a->home * a->counts);
        printf("%s: %g counts/mm, dest %g\n", a->name, a->counts, chan[a->axis].Dest);
    }
}
//@ cycles: 29241
