//@ prints: 11111000
// A 64-bit value that is copied to itself keeps its registers through the loop, also past a read that nothing uses.
#include "KMotionDef.h"

double values[8];
char counts[8];
int offsets[8];

int count(long long n)
{
    int i;

    for (i = 0; i != 5; ++i) {
        n <<= 0;
        if ((short)(n % 7))
            counts[(i | offsets[3]) & 7]++;
        if (values[7] > -1e6 && values[7] < 1e6 ? values[7] : 7)
            ;
    }
    return 0;
}

main()
{
    unsigned sum = 0;
    int i = count(1);

    for (i = 0; i < 8; i++)
        sum = sum * 10 + counts[i];
    printf("%d\n", sum);
}
//@ cycles: 4822
