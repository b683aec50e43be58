int printf(const char *format, ...);
struct point { int x, y; double z; };
struct point mirror(struct point p) { struct point q; q.x = p.y; q.y = p.x; q.z = -p.z; return q; }
int many(int a, double b, int c, int d, int e, int f, int g, int h, double i, int j, int k, double l, float m)
{ return a + b + c * 2 + d * 3 + e * 4 + f * 5 + g * 6 + h * 7 + i + j * 8 + k * 9 + l + m; }
int sum(int n, ...) { return n; }
int pick(int k) { switch (k) { case 0: return 5; case 1: return 7; case 2: return 11; case 3: return 13; case 4: return 17; case 5: return 19; } return -1; }
static int apply(int (*f)(int), int x) { return f(x) + f(x + 1); }
unsigned state = 12345;
unsigned next(void) { state = state * 1664525u + 1013904223u; return state; }
int main(void)
{
    int i; unsigned hash = 0; struct point p, q; int a[5] = {1, 2}; double d; long long big;
    for (i = 0; i < 3000; i++) {
        unsigned w[2], v[2], *r; float f, g, h;
        w[0] = next(); w[1] = next() & 0x800FFFFF | (1000 + next() % 47 << 20);
        v[0] = next(); v[1] = next() & 0x800FFFFF | (1000 + next() % 47 << 20);
        d = *(double *)w / *(double *)v;
        r = (unsigned *)&d;
        hash = hash * 31 + r[0]; hash = hash * 31 + r[1];
        w[0] = next() & 0x807FFFFF | (110 + next() % 30 << 23);
        v[0] = next() & 0x807FFFFF | (110 + next() % 30 << 23);
        f = *(float *)w; g = *(float *)v; h = f / g;
        hash = hash * 31 + *(unsigned *)&h;
    }
    printf("%08x\n", hash);
    p.x = 3; p.y = 4; p.z = 2.5; q = mirror(p);
    printf("%d %d %f\n", q.x, q.y, q.z);
    printf("%d\n", many(1, 2.0, 3, 4, 5, 6, 7, 8, 9.0, 10, 11, 12.0, 13.0f));
    printf("%d %d %d %d\n", a[0], a[1], a[2], a[4]);
    for (i = -1; i < 7; i++) printf("%d ", pick(i));
    printf("%d\n", apply(pick, 2));
    big = 1234567890123ll;
    for (i = 1; i < 40; i++) { big = big * 31 - (big >> i) + (big << (i & 7)) % 1000003; hash = hash * 7 + (unsigned)big + (unsigned)(big >> 32); hash += (unsigned)(big / (i * 77777ll)); }
    printf("%08x\n", hash);
    printf("%d %d\n", 0x80000000u < 1, (unsigned)-1 > 5u);
    d = 1e300; printf("%d %d\n", (int)(d * 1e10 > 1e305), (int)-3.99);
    { float f = 3.0e9f; unsigned u = (unsigned)f; double e = u; printf("%u %f\n", u, e); }
    return hash & 0x7f;
}
