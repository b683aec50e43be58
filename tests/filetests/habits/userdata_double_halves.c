// A double in two elements of persist.UserData, moved word by word as the common helper file does.
//@ prints: 1.234567890123
//@ prints: 3ff3c0ca
#include "KMotionDef.h"

#define VAR 20

void SetUserDataDouble(int i, double v)
{
    double d = v;
    persist.UserData[i * 2] = ((int *)(&d))[0];
    persist.UserData[i * 2 + 1] = ((int *)(&d))[1];
}

double GetUserDataDouble(int i)
{
    double d;
    ((int *)(&d))[0] = persist.UserData[i * 2];
    ((int *)(&d))[1] = persist.UserData[i * 2 + 1];
    return d;
}

main()
{
    SetUserDataDouble(VAR, 1.234567890123);
    printf("%.12f\n", GetUserDataDouble(VAR));
    printf("%x\n", persist.UserData[VAR * 2 + 1]);
}
//@ cycles: 11156
