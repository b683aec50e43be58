//@ prints: 1830 60
#include "KMotionDef.h"
#define TEN(f, n) f(n##0), f(n##1), f(n##2), f(n##3), f(n##4), f(n##5), f(n##6), f(n##7), f(n##8), f(n##9)
#define PARAMETER(n) int p##n
#define ARGUMENT(n) 1##n - 99
#define SUM10(n) p##n##0 + p##n##1 + p##n##2 + p##n##3 + p##n##4 + p##n##5 + p##n##6 + p##n##7 + p##n##8 + p##n##9

int sum(TEN(PARAMETER, 0), TEN(PARAMETER, 1), TEN(PARAMETER, 2), TEN(PARAMETER, 3), TEN(PARAMETER, 4), TEN(PARAMETER, 5))  //~ vendor-parameter
{
    last(p59);
    return SUM10(0) + SUM10(1) + SUM10(2) + SUM10(3) + SUM10(4) + SUM10(5);
}

int largest;
last(int n) { largest = n; }

main()
{
    int all = sum(TEN(ARGUMENT, 0), TEN(ARGUMENT, 1), TEN(ARGUMENT, 2), TEN(ARGUMENT, 3), TEN(ARGUMENT, 4), TEN(ARGUMENT, 5));
    printf("%d %d\n", all, largest);
}
//@ cycles: 5861
