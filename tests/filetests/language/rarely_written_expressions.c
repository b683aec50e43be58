// Expressions that few programs have: what is printed was printed by gcc's program, too.
//@ prints: 2 3
//@ prints: 41
//@ prints: 12
//@ prints: 6 40000 -40000
//@ prints: 4 1
//@ prints: 8
//@ prints: text
//@ prints: -1 1
//@ prints: 1 1 0
//@ prints: 2
#include <stdarg.h>
int printf(const char *format, ...);

struct place { int x, y; };
struct place a = { 1, 2 }, b = { 3, 4 };

static int sum_twice(int count, ...)
{
    va_list first, second;
    int i, sum = 0;

    va_start(first, count);
    va_copy(second, first);
    for (i = 0; i < count; i++) sum += va_arg(first, int);
    for (i = 0; i < count; i++) sum += va_arg(second, int);
    va_end(first);
    va_end(second);
    return sum;
}

static void count(int *n) { ++*n; }

main()
{
    int n = 5, numbers[6], *p = numbers + 4, *q = numbers;
    unsigned short s = 40000;
    char *text = "text";
    double d = -1.5;
    float f = 3e9f;
    long long big;
    unsigned long long ubig;

    printf("%d %d\n", (n > 3 ? a : b).y, (n > 9 ? a : b).x);
    printf("%d\n", ({ struct place t = a; t.x += 40; t; }).x);
    printf("%d\n", sum_twice(3, 1, 2, 3));
    n > 3 ? count(&n) : (void)0;
    n > 9 ? count(&n) : (void)0;
    printf("%d %d %d\n", n, +s, -s);
    printf("%d %d\n", (int)(p - q), p - 2 > q);
    printf("%d\n", *(n ? p - n + n : 0) = 8);
    printf("%s\n", n ? text : 0);
    big = d;
    ubig = f;
    printf("%d %d\n", (int)big, ubig == 3000000000u);
    big = f;
    printf("%d %d %d\n", big == 3000000000ll, (_Bool)0.5, (_Bool)(d + 1.5));
    printf("%d\n", _Generic(d, int: 1, double: 2, default: 3));
}
//@ cycles: 42567
