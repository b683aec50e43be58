//@ args: check
//@ snapshot
#include "KMotionDef.h"

double Mean(int axis)
{
    double samples[110];
    int i;
    double sum = 0;
    for (i = 0; i < 110; i++)
    {
        samples[i] = chan[axis].Position;
        Delay_sec(0.01);
    }
    for (i = 0; i < 110; i++) sum += samples[i];
    return sum / 110;
}

double Drift(int axis)
{
    double before[120];
    int i;
    for (i = 0; i < 120; i++) before[i] = Mean(axis);
    return before[119] - before[0];
}

main()
{
    char text[1100];
    sprintf(text, "%f", Drift(2));
    printf("%s\n", text);
}
