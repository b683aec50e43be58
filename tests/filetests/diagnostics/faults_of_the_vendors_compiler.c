//@ args: check -Wno-constant-comparison -Wno-parameter-copy -Wvendor
//@ snapshot
#include "KMotionDef.h"

struct Point { double x, y; };
struct Lamp { char red, green, blue, white, blink; };

unsigned char bytes[10];
char chars[10];

void Clear(int *x) { *x = 0; }

void Address(int a, double d[3], struct Lamp *p)
{
    Clear(&a);
    d = &d[1];
    Clear((int *)&p);
}

void Compare(unsigned a, unsigned b, unsigned char c, double *p)
{
    if (a < b || a >= 0) a = 0;
    if ((int)a < 5u) b = 0;
    if (p > (double *)0) p = 0;
    if (c < sizeof(int) || (a & 7) > 3u || a >> 1 < b >> 4 || a % 10 > 5 || a == b) c = 0;
    if (p < (double *)0xfffffffc || p < gather_buffer) p = 0;
}

void Local(void)
{
    int a[5] = {1, 2}, b[2] = {1, 2}, c[2][2] = {{1}, {2, 3}}, empty[3] = {};
    struct { char n; double d; } s = {1, 2}, t = {1};
    char text[20] = "axis";
    Clear(a);
    printf("%d %d %d %d %g %g %s\n", b[0], c[0][1], empty[0], s.n, s.d, t.d, text);
}

void Chain(struct Lamp *p, int i, unsigned *u)
{
    p->red = p->green = p->blue = p->white = 0;
    p->red = p->green = p->blue = p->white = p->blink = 0;
    chars[i] = chars[i + 1] = chars[i + 2] = chars[i + 3] = 1;
    bytes[i] = bytes[i + 1] = bytes[i + 2] = bytes[i + 3] = 1;
    chars[0] = chars[1] = chars[2] = chars[3] = chars[4] = chars[5] = 1;
    u[0] = u[1] = u[2] = u[3] = u[4] = u[5] = 1;
    u[0] = u[1] = u[2] = u[3] = u[4] = u[5] = u[6] = 1;
}

struct Point Center(void)
{
    struct Point p;
    p.x = p.y = 0;
    return p;
}

main()
{
}
