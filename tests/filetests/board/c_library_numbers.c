// Text to numbers, the heap, parts of numbers, and an end in the middle, as a computer's C library does them: what is
// printed was printed by gcc's program, too.
//@ prints: -42 42 0.250 0.0
//@ prints: 4000000000 31 63 12abc -125.0000 rest
//@ prints: 6 0 1
//@ prints: -0.75 -3 0.7500 6 48.0
//@ prints: 0.50 2 -0.6250 -2 -0.156
//@ prints:  1 1 1
int printf(const char *format, ...);
long atol(const char *text);
double atof(const char *text);
unsigned long strtoul(const char *text, char **end, int base);
double strtod(const char *text, char **end);
void *calloc(unsigned count, unsigned size);
void *malloc(unsigned size);
void free(void *block);
long labs(long x);
int rand(void);
void srand(unsigned seed);
double modf(double x, double *whole);
double frexp(double x, int *exponent);
double ldexp(double x, int n);
float modff(float x, float *whole);
float frexpf(float x, int *exponent);
float ldexpf(float x, int n);
void exit(int code);

int again[3];

main()
{
    char *end, *text = "4000000000 0x1F 077 12abc";
    double whole;
    float wholef;
    int *block, exponent, i;

    printf("%d %d %.3f %.1f\n", (int)atol(" -42x"), (int)labs(-42), atof("2.5e-1mm"), atof("none"));
    printf("%u ", (unsigned)strtoul(text, &end, 10));
    printf("%u ", (unsigned)strtoul(end, &end, 16));
    printf("%u ", (unsigned)strtoul(end, &end, 0));
    printf("%u", (unsigned)strtoul(end, &end, 10));
    printf("%s ", end);
    printf("%.4f", strtod("-1.25e2 rest", &end));
    printf("%s\n", end);

    block = calloc(4, sizeof(int));
    for (i = 0; i < 4; i++) block[i] += i;
    printf("%d %d %d\n", block[0] + block[1] + block[2] + block[3], (int)block % 8, calloc(0x40000000, 0x40) == 0);
    free(block);
    free(0);

    printf("%.2f ", modf(-3.75, &whole));
    printf("%.0f ", whole);
    printf("%.4f ", frexp(48.0, &exponent));
    printf("%d %.1f\n", exponent, ldexp(0.75, 6));
    printf("%.2f ", modff(2.5f, &wholef));
    printf("%.0f ", wholef);
    printf("%.4f ", frexpf(-0.15625f, &exponent));
    printf("%d %.3f\n", exponent, ldexpf(-0.625f, -2));

    srand(7);
    for (i = 0; i < 3; i++) again[i] = rand();
    srand(7);
    for (i = 0; i < 3; i++) printf(" %d", again[i] == rand() && again[i] >= 0);
    printf("\n");
    exit(3);
    printf("not here\n");
}
//@ cycles: 98582
