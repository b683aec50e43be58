//@ args: check -Wrecursion
//@ snapshot
#include "KMotionDef.h"

int Odd(int n);

int Even(int n)
{
    return n == 0 ? 1 : Odd(n - 1);
}

int Odd(int n)
{
    return n == 0 ? 0 : Even(n - 1);
}

int Sum(int n)
{
    return n > 0 ? n + Sum(n - 1) : 0;
}

int NeverCalled(void)
{
    return NeverCalled();
}

main()
{
    printf("%d %d\n", Even(4), Sum(3));
}
