// An attribute may begin a declarator in parentheses, with a name or without one, and a parameter.
//@ prints: 7
//@ prints: 14 3
//@ prints: 4
#include "KMotionDef.h"

static int seven(void) { return 7; }

static int twice(int (__attribute__((noinline)) *f)(void)) { return f() + f(); }

static int plus(__attribute__((unused)) int unused, int n) { return n + 1; }

int main(void)
{
    void *any = (void *)seven;
    int (__attribute__((noinline)) *f)(void) = seven;
    int (*g)(__attribute__((unused)) int, int) = plus;

    printf("%d\n", ((int (__attribute__((noinline)) *)(void))any)());
    printf("%d %d\n", twice(f), g(0, 2));
    printf("%d\n", (int)sizeof(int (__attribute__((aligned(4), unused)) __attribute__((unused)) *)(void)));
    return 0;
}
//@ cycles: 9825
