// What the firmware lacks of <stdlib.h>, and <assert.h>.

//@ abs
int abs(int x) { return x < 0 ? -x : x; }

//@ labs
long labs(long x) { return x < 0 ? -x : x; }

//@ llabs
long long llabs(long long x) { return x < 0 ? -x : x; }

//@ atof
double strtod(const char *text, char **end);

double atof(const char *text) { return strtod(text, (char **)0); }

//@ atol
long strtol(const char *text, char **end, int base);

long atol(const char *text) { return strtol(text, (char **)0, 10); }

//@ atoll
long long strtoll(const char *text, char **end, int base);

long long atoll(const char *text) { return strtoll(text, (char **)0, 10); }

//@ strtoll
unsigned long long strtoull(const char *text, char **end, int base);

long long strtoll(const char *text, char **end, int base) { return (long long)strtoull(text, end, base); }

//@ strtoull
static int digit(int c)
{
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    c |= 32;
    return c >= 'a' && c <= 'z' ? c - 'a' + 10 : 99;
}

unsigned long long strtoull(const char *text, char **end, int base)
{
    const char *at = text, *digits;
    unsigned long long value = 0;
    int negative = 0;
    while (*at == ' ' || (*at >= '\t' && *at <= '\r')) {
        at++;
    }
    if (*at == '-' || *at == '+') {
        negative = *at++ == '-';
    }
    if ((base == 0 || base == 16) && at[0] == '0' && (at[1] | 32) == 'x' && digit(at[2]) < 16) {
        at += 2;
        base = 16;
    } else if (base == 0) {
        base = *at == '0' ? 8 : 10;
    }
    digits = at;
    while (digit(*at) < base) {
        value = value * base + digit(*at++);
    }
    if (end) {
        *end = (char *)(at == digits ? text : at);
    }
    return negative ? -value : value;
}

//@ div
typedef struct { int quot, rem; } div_t;

div_t div(int numerator, int denominator)
{
    div_t result;
    result.quot = numerator / denominator;
    result.rem = numerator % denominator;
    return result;
}

//@ ldiv
typedef struct { long quot, rem; } ldiv_t;

ldiv_t ldiv(long numerator, long denominator)
{
    ldiv_t result;
    result.quot = numerator / denominator;
    result.rem = numerator % denominator;
    return result;
}

//@ lldiv
typedef struct { long long quot, rem; } lldiv_t;

lldiv_t lldiv(long long numerator, long long denominator)
{
    lldiv_t result;
    result.quot = numerator / denominator;
    result.rem = numerator % denominator;
    return result;
}

//@ getenv
char *getenv(const char *name)
{
    (void)name;
    return 0;
}

//@ errno
int errno;

//@ __assertion_failed
int printf(const char *format, ...);
void abort(void);

void __assertion_failed(const char *condition, const char *file, int line)
{
    printf("%s:%d: assertion failed: %s\n", file, line, condition);
    abort();
}
