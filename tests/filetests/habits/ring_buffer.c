// A delay line of floats; index arithmetic with a mask.
//@ prints: 0.00 0.00 1.00 1.50
//@ prints: average 1.75
#include "KMotionDef.h"

#define SIZE 1024
#define MASK (SIZE - 1)
#define LAG 3

float ring[SIZE];
int in;

float Delayed(float x)
{
    ring[in & MASK] = x;
    return ring[(in++ - LAG) & MASK];
}

main()
{
    float last[4], sum = 0;
    int i;
    Delayed(0);
    for (i = 0; i < 5; i++)
    {
        float y = Delayed(1 + i * 0.5f);
        if (i > 0) last[i - 1] = y;
    }
    printf("%.2f %.2f %.2f %.2f\n", last[0], last[1], last[2], last[3]);
    for (i = 1; i <= 4; i++) sum += ring[i];
    printf("average %.2f\n", sum / 4);
}
//@ cycles: 20284
