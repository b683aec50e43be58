//@ args: check
// Elements by a parameter: every call stays inside, or the function looks at its argument first.
#include "KMotionDef.h"

double speed[3] = { 1, 2, 3 };
int used[3];

double Speed(int axis)
{
    if (axis < 0 || axis > 2) return 0;
    return speed[axis];
}

double Next(int axis)
{
    axis = (axis + 1) % 3;
    return speed[axis];
}

void Use(int axis)
{
    used[axis]++;
    used[axis - 0] += axis < 2 ? used[axis + 1] : 0;
}

main()
{
    int i;
    double sum = 0;
    for (i = 0; i < 3; i++) Use(i);
    for (i = 0; i < 5; i++) sum += Speed(i);
    sum += Next(2) + Speed(7);
    printf("%f %d\n", sum, used[0]);
}
