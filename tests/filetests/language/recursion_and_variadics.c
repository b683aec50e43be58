//@ prints: 3628800 6765
//@ prints: 3 60 1.5
#include "KMotionDef.h"
#include <stdarg.h>

int factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }
int fibonacci(int n) { return n < 2 ? n : fibonacci(n - 1) + fibonacci(n - 2); }

int total(double *last, int count, ...)
{
    int sum = 0;
    va_list list;
    va_start(list, count);
    while (count-- > 0) sum += va_arg(list, int);
    *last = va_arg(list, double);
    va_end(list);
    return sum;
}

main()
{
    double last;
    int sum;
    printf("%d %d\n", factorial(10), fibonacci(20));
    sum = total(&last, 3, 10, 20, 30, 1.5);
    printf("%d %d %.1f\n", 3, sum, last);
}
//@ cycles: 200655
