//@ prints: 0 0
#include "KMotionDef.h"

int main(int count, char **words) //~ main-parameters
{
    printf("%d %d\n", count, words != 0);
    return 0;
}
//@ cycles: 4550
