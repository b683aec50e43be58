//@ prints: 3 -3 2 -2
#include "KMotionDef.h"

struct Three { char c[3]; } list[4];
int numbers[4];

main()
{
    printf("%d %d %d %d\n", &numbers[3] - numbers, numbers - &numbers[3], &list[2] - list, list - &list[2]);
}
//@ cycles: 9056
