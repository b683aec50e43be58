// Measured errors of a screw between which is interpolated.
//@ prints: 0.000 0.005 0.010 0.002 -0.006 -0.006
#include "KMotionDef.h"

#define N 4
#define PITCH 100.0

double Error[N] = { 0.0, 0.010, -0.002,
                    -0.006, };

double Correction(double x)
{
    int i = x / PITCH;
    double f;
    if (i >= N - 1) return Error[N - 1];
    f = x / PITCH - i;
    return Error[i] + f * (Error[i + 1] - Error[i]);
}

main()
{
    printf("%.3f %.3f %.3f %.3f %.3f %.3f\n", Correction(0), Correction(50), Correction(100), Correction(166.6667),
           Correction(300), Correction(1000));
}
//@ cycles: 22343
