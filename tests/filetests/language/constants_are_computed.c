// What the compiler computes by itself, of all types: what is printed was printed by gcc's program, too.
//@ prints: 01234565ba14557e
//@ prints: 0123456959434660
//@ prints: c4d5e6f9f9a91181
//@ prints: ffffffffff5f283c
//@ prints: 000000011cecb06b
//@ prints: ffffffffb9ebcfef
//@ prints: 000548fd367c6dfe
//@ prints: 0000000000001482
//@ prints: fedcba9876543211
//@ prints: 00000001cf977870
//@ prints: 468acf13579bde00
//@ prints: ffffffffc60d10f1
//@ prints: 000000000000000f
//@ prints: 00000006fc23ac00
//@ prints: f9ccd8a1c5080000
//@ prints: fffffffffffffffe
//@ prints: -123456 3735928 559 -123443
//@ prints: -987648 -15432 116747767 123455
//@ prints: 2.750 -6.500 -30000000000.0
//@ prints: 43723456789abcdf
//@ prints: 43efdb97530eca86
//@ prints: 4372345680000000
//@ prints: 43efdb9760000000
//@ prints: 41ebd5b7e0000000
//@ prints: 3735928559 3000000000 4000000000
//@ prints: 1 0 1 0
int printf(const char *format, ...);

static void show(long long value)
{
    printf("%08x%08x\n", (unsigned)(value >> 32), (unsigned)value);
}

// A double with more digits than printf of the board prints right.
static void show_bits(double value)
{
    show(*(long long *)&value);
}

main()
{
    long long a = 0x123456789abcdefll, b = -7777777777ll;
    unsigned long long u = 0xfedcba9876543210ull;
    int i = -123456, j = 77;
    unsigned n = 0xdeadbeef;
    float f = -2.75f;
    double d = 3.0e10;

    show(a + b);
    show(a - b);
    show(a * b);
    show(a / b);
    show(a % b);
    show((a & u) ^ (a | b));
    show(u / 12345);
    show(u % 12345);
    show(-a);
    show(~b);
    show(a << 9);
    show(b >> 3);
    show(u >> 60);
    show((long long)d);
    show((unsigned long long)1.8e19);
    show((long long)f);
    printf("%d %u %d %d\n", i / j * j + i % j, n / 1000u, (int)(n % 1000u), (i ^ j) | (i & j));
    printf("%d %d %u %d\n", i << 3, i >> 3, n >> 5, ~i);
    printf("%.3f %.3f %.1f\n", -f, f * 2 - 1, -d);
    show_bits(a);
    show_bits(u);
    show_bits((float)a);
    show_bits((float)u);
    show_bits((float)n);
    printf("%.0f %u %u\n", (double)n, (unsigned)3e9f, (unsigned)4e9);
    printf("%d %d %d %d\n", a > b, u < 5, f <= -2.75f, d != 3e10);
}
//@ cycles: 245270
