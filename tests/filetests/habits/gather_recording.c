// Values are recorded as doubles and read back through a pointer that runs along.
//@ prints: 0.00 1.00 4.00 9.00 16.00
//@ prints: sum 30
#include "KMotionDef.h"

#define N 5

main()
{
    double *p = gather_buffer;
    double sum = 0;
    int i;

    for (i = 0; i < N; i++) *p++ = i * i;
    p = gather_buffer;
    for (i = 0; i < N; i++)
    {
        sum += p[i];
        printf(i < N - 1 ? "%.2f " : "%.2f\n", p[i]);
    }
    printf("sum %g\n", sum);
}
//@ cycles: 25550
