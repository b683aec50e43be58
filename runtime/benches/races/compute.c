/* Computes in its own memory and tells another thread how far it has come. */
#include "KMotionDef.h"

double own[256];

main()
{
    int i, k;
    double s = 0;

    for (k = 0;; k++)
    {
        for (i = 0; i < 256; i++)
            own[i] += 0.5 * i + s;
        s += own[k & 255] * 1e-9;
        persist.UserData[50] = k;
    }
}
