//@ prints: out of the sort 0.25
//@ prints: 15 117 210
//@ prints: 3
#include <stdio.h>
#include <setjmp.h>
#include <stdlib.h>
jmp_buf b;
void (*leave)(jmp_buf, int) = longjmp;
int compare(const void *x, const void *y) { leave(b, 3); return 0; }
struct Big { int a[40]; };
struct Big f(struct Big in, int n, ...)
{
    struct Big out = in;
    int r = setjmp(b);
    if (r < 2) { out.a[r] += r + n; n += 100; longjmp(b, r + 1); }
    out.a[2] = n;
    return out;
}
main()
{
    int v[4] = {3, 1, 2, 0}, *p = 0;
    struct Big big = {{5, 6}}, res;
    double x = 0.25;
    if (setjmp(b) == 0) { qsort(v, 4, sizeof(int), compare); printf("never\n"); }
    else printf("out of the sort %g\n", x);
    res = f(big, 10, 1, 2);
    printf("%d %d %d\n", res.a[0], res.a[1], res.a[2]);
    if (setjmp(b) == 0) { p = v; longjmp(b, 1); }
    printf("%d\n", *p);
}
//@ cycles: 18065
