//@ prints: 0 0 1.5 0
//@ prints: 7 1 3 0
//@ prints: 2 2 6 0
//@ prints: 3 3 12 0
//@ prints: 4 4 24 0
//@ prints: 10 10
//@ prints: one
#include <setjmp.h>
#include <stdio.h>
jmp_buf top, inner;
int depth;
double level(int n, double x)
{
    double kept = x * 2;
    depth = n;
    if (n == 0) longjmp(top, 7);
    return kept + level(n - 1, x + 1);
}
int parse(int n)
{
    int i, sum = 0;
    int r = setjmp(inner);
    for (i = r; i < 5; i++) {
        sum += i;
        if (i == n) longjmp(inner, i + 1);
    }
    return sum;
}
void again(jmp_buf place, int value) { longjmp(place, value); }
main()
{
    int count = 0, value;
    double d = 1.5;
    value = setjmp(top);
    printf("%d %d %g %d\n", value, count, d, depth);
    count++;
    d = d * 2;
    if (value == 0) level(10, 1.0);
    if (count < 5) again(top, count);
    printf("%d %d\n", parse(2), parse(9));
    switch (setjmp(top)) {
    case 0: longjmp(top, 0);
    case 1: printf("one\n"); break;  //~ fall-through
    default: printf("other\n");
    }
}
//@ cycles: 57362
