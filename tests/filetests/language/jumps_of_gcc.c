//@ prints: 1 7
#include <stdio.h>

unsigned long long place[5];

void deep(void)
{
    __builtin_longjmp(&place, 1);
}

int keeps(int x)
{
    int a = 0;

    if (__builtin_setjmp(&place) == 0) {
        while (1) {
            a = 1;
            deep();
        }
    }
    printf("%d ", a);
    return x;
}

main()
{
    printf("%d\n", keeps(7));
}
//@ cycles: 5038
