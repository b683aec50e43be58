// What C99 adds to <math.h>, on top of the firmware's functions and of math.c.

//@ log1p
double log(double x);

double log1p(double x)
{
    double sum = 1.0 + x;
    return sum == 1.0 || sum - sum != 0.0 ? x : log(sum) * (x / (sum - 1.0));
}

//@ expm1
double exp(double x);
double log(double x);

double expm1(double x)
{
    double power;
    if (x > 40.0 || x < -40.0) {
        return exp(x) - 1.0;
    }
    power = exp(x);
    if (power == 1.0) {
        return x;
    }
    return power - 1.0 == -1.0 ? -1.0 : (power - 1.0) * (x / log(power));
}

//@ asinh
double fabs(double x);
double log(double x);
double log1p(double x);
double sqrt(double x);

double asinh(double x)
{
    double size = fabs(x), square = size * size;
    size = size > 1e8 ? log(size) + 0.69314718055994530942
                      : log1p(size + square / (1.0 + sqrt(square + 1.0)));
    return x < 0.0 ? -size : size;
}

//@ acosh
double log(double x);
double log1p(double x);
double sqrt(double x);

double acosh(double x)
{
    double above = x - 1.0;
    if (x > 1e8) {
        return log(x) + 0.69314718055994530942;
    }
    return above < 0.0 ? 0.0 * x / 0.0 : log1p(above + sqrt(above * (above + 2.0)));
}

//@ atanh
double log1p(double x);

double atanh(double x) { return x == 0.0 ? x : 0.5 * log1p(2.0 * x / (1.0 - x)); }

//@ erf
// A sum of positive terms; from 3 on 1 less the rest.
double erfc(double x);
double exp(double x);
double fabs(double x);

double erf(double x)
{
    double size = fabs(x), term = size, sum = size, n;
    if (size != size) {
        return x;
    }
    if (size >= 3.0) {
        sum = 1.0 - erfc(size);
    } else {
        for (n = 1.0; term > sum * 1e-17; n += 1.0) {
            term *= 2.0 * size * size / (2.0 * n + 1.0);
            sum += term;
        }
        sum *= 1.12837916709551257390 * exp(-size * size);
    }
    return x < 0.0 ? -sum : sum;
}

//@ erfc
// A continued fraction from 3 on, else 1 less the sum.
double erf(double x);
double exp(double x);

double erfc(double x)
{
    double fraction = x;
    int n;
    if (!(x >= 2.0)) {
        return 1.0 - erf(x);
    }
    if (x > 27.3) {
        return 0.0;
    }
    for (n = 100; n > 0; n--) {
        fraction = x + 0.5 * n / fraction;
    }
    return exp(-x * x) / (fraction * 1.77245385090551602730);
}

//@ __gamma_sum
// The sum of Lanczos' approximation with g = 7.
double __gamma_sum(double x)
{
    return 0.99999999999980993 + 676.5203681218851 / (x + 1.0) - 1259.1392167224028 / (x + 2.0)
           + 771.32342877765313 / (x + 3.0) - 176.61502916214059 / (x + 4.0) + 12.507343278686905 / (x + 5.0)
           - 0.13857109526572012 / (x + 6.0) + 9.9843695780195716e-6 / (x + 7.0)
           + 1.5056327351493116e-7 / (x + 8.0);
}

//@ tgamma
double __gamma_sum(double x);
double exp(double x);
double floor(double x);
double pow(double x, double y);
double sin(double x);

double tgamma(double x)
{
    double product = 1.0, half;
    if (x <= 0.0 && floor(x) == x) {
        return 0.0 / (x - x);
    }
    if (x < 0.5) {
        return 3.14159265358979323846 / (sin(3.14159265358979323846 * x) * tgamma(1.0 - x));
    }
    if (floor(x) == x && x < 172.0) {
        for (; x > 2.0; x -= 1.0) {
            product *= x - 1.0;
        }
        return product;
    }
    half = pow(x + 6.5, 0.5 * (x - 0.5));
    return 2.50662827463100050242 * half * exp(-(x + 6.5)) * half * __gamma_sum(x - 1.0);
}

//@ lgamma
double __gamma_sum(double x);
double fabs(double x);
double floor(double x);
double log(double x);
double sin(double x);

double lgamma(double x)
{
    if (x == 1.0 || x == 2.0) {
        return 0.0;
    }
    if (x <= 0.0 && floor(x) == x) {
        return 1e300 * 1e300;
    }
    if (x < 0.5) {
        return log(3.14159265358979323846 / fabs(sin(3.14159265358979323846 * x))) - lgamma(1.0 - x);
    }
    return 0.91893853320467274178 + (x - 0.5) * log(x + 6.5) - (x + 6.5) + log(__gamma_sum(x - 1.0));
}

//@ scalbn
double ldexp(double x, int n);

double scalbn(double x, int n) { return ldexp(x, n); }

//@ scalbln
double ldexp(double x, int n);

double scalbln(double x, long n) { return ldexp(x, (int)n); }

//@ ilogb
int __float_class(double x);
double frexp(double x, int *exponent);

int ilogb(double x)
{
    int exponent;
    switch (__float_class(x)) {
    case 0:
    case 1:
        return 0x7fffffff;
    case 2:
        return -0x7fffffff;
    }
    frexp(x, &exponent);
    return exponent - 1;
}

//@ logb
int __float_class(double x);
int ilogb(double x);

double logb(double x)
{
    switch (__float_class(x)) {
    case 0:
    case 1:
        return x * x;
    case 2:
        return -1e300 * 1e300;
    }
    return (double)ilogb(x);
}

//@ llround
double round(double x);

long long llround(double x) { return (long long)round(x); }

//@ llrint
double rint(double x);

long long llrint(double x) { return (long long)rint(x); }

//@ remquo
double fabs(double x);
double fmod(double x, double y);
int __float_sign(double x);

double remquo(double x, double y, int *quotient)
{
    double divisor = fabs(y), rest = fmod(fabs(x), 8.0 * divisor);
    int whole = 0, i;
    for (i = 4; i; i >>= 1) {
        if (rest >= i * divisor) {
            rest -= i * divisor;
            whole += i;
        }
    }
    if (rest > divisor - rest || (rest == divisor - rest && (whole & 1))) {
        rest -= divisor;
        whole++;
    }
    *quotient = __float_sign(x) == __float_sign(y) ? whole & 7 : -(whole & 7);
    return __float_sign(x) ? -rest : rest;
}

//@ remainder
double remquo(double x, double y, int *quotient);

double remainder(double x, double y)
{
    int quotient;
    return remquo(x, y, &quotient);
}

//@ nextafter
double nextafter(double x, double y)
{
    long long *bits = (long long *)&x;
    if (x != x || y != y) {
        return x + y;
    }
    if (x == y) {
        return y;
    }
    if (x == 0.0) {
        *bits = 1;
        return y < 0.0 ? -x : x;
    }
    *bits += (x < y) == (x > 0.0) ? 1 : -1;
    return x;
}

//@ nextafterf
float nextafterf(float x, float y)
{
    int *bits = (int *)&x;
    if (x != x || y != y) {
        return x + y;
    }
    if (x == y) {
        return y;
    }
    if (x == 0.0f) {
        *bits = 1;
        return y < 0.0f ? -x : x;
    }
    *bits += (x < y) == (x > 0.0f) ? 1 : -1;
    return x;
}

//@ fdim
double fdim(double x, double y) { return x <= y ? 0.0 : x - y; }

//@ nan
double nan(const char *tag)
{
    long long bits = 0x7ff8000000000000;
    (void)tag;
    return *(double *)&bits;
}

//@ fma
// The product and the sum with what they lose, and the lost part added with its last bit set if it is not exact.
double __split(double x, double *low);

double fma(double x, double y, double z)
{
    double xl, yl, xh, yh, product, lost, high, low, part, sum, error;
    product = x * y;
    if (product - product != 0.0 || z - z != 0.0 || product == 0.0) {
        return product + z;
    }
    xh = __split(x, &xl);
    yh = __split(y, &yl);
    lost = ((xh * yh - product) + xh * yl + xl * yh) + xl * yl;
    high = product + z;
    part = high - product;
    low = (product - (high - part)) + (z - part);
    sum = low + lost;
    part = sum - low;
    error = (low - (sum - part)) + (lost - part);
    if (error != 0.0 && !(*(unsigned *)&sum & 1)) {
        *(long long *)&sum += (error > 0.0) == (sum > 0.0) ? 1 : -1;
    }
    return high + sum;
}

//@ __split
// The upper half of a number's digits; what is left is the lower half.
double __split(double x, double *low)
{
    double high = x;
    *(unsigned *)&high &= 0xf8000000;
    *low = x - high;
    return high;
}

//@ log1pf
double log1p(double x);

float log1pf(float x) { return (float)log1p(x); }

//@ expm1f
double expm1(double x);

float expm1f(float x) { return (float)expm1(x); }

//@ asinhf
double asinh(double x);

float asinhf(float x) { return (float)asinh(x); }

//@ acoshf
double acosh(double x);

float acoshf(float x) { return (float)acosh(x); }

//@ atanhf
double atanh(double x);

float atanhf(float x) { return (float)atanh(x); }

//@ erff
double erf(double x);

float erff(float x) { return (float)erf(x); }

//@ erfcf
double erfc(double x);

float erfcf(float x) { return (float)erfc(x); }

//@ tgammaf
double tgamma(double x);

float tgammaf(float x) { return (float)tgamma(x); }

//@ lgammaf
double lgamma(double x);

float lgammaf(float x) { return (float)lgamma(x); }

//@ logbf
double logb(double x);

float logbf(float x) { return (float)logb(x); }

//@ rintf
double rint(double x);

float rintf(float x) { return (float)rint(x); }

//@ nearbyintf
double nearbyint(double x);

float nearbyintf(float x) { return (float)nearbyint(x); }

//@ cbrtf
double cbrt(double x);

float cbrtf(float x) { return (float)cbrt(x); }

//@ remainderf
double remainder(double x, double y);

float remainderf(float x, float y) { return (float)remainder(x, y); }

//@ fdimf
double fdim(double x, double y);

float fdimf(float x, float y) { return (float)fdim(x, y); }

//@ fmaf
double fma(double x, double y, double z);

float fmaf(float x, float y, float z) { return (float)fma(x, y, z); }

//@ nanf
double nan(const char *tag);

float nanf(const char *tag) { return (float)nan(tag); }

//@ remquof
double remquo(double x, double y, int *quotient);

float remquof(float x, float y, int *quotient) { return (float)remquo(x, y, quotient); }

//@ scalbnf
double ldexp(double x, int n);

float scalbnf(float x, int n) { return (float)ldexp(x, n); }

//@ scalblnf
double ldexp(double x, int n);

float scalblnf(float x, long n) { return (float)ldexp(x, (int)n); }

//@ ilogbf
int ilogb(double x);

int ilogbf(float x) { return ilogb(x); }

//@ lrintf
long lrint(double x);

long lrintf(float x) { return lrint(x); }

//@ lroundf
long lround(double x);

long lroundf(float x) { return lround(x); }

//@ llrintf
long long llrint(double x);

long long llrintf(float x) { return llrint(x); }

//@ llroundf
long long llround(double x);

long long llroundf(float x) { return llround(x); }

//@ sinh
double exp(double x);
double expm1(double x);
double fabs(double x);

double sinh(double x)
{
    double half = x < 0.0 ? -0.5 : 0.5, power;
    if (fabs(x) > 40.0) {
        power = exp(0.5 * fabs(x));
        return half * power * power;
    }
    power = expm1(fabs(x));
    return half * (power + power / (power + 1.0));
}

//@ cosh
double exp(double x);
double fabs(double x);

double cosh(double x)
{
    double power = exp(0.5 * fabs(x));
    if (fabs(x) > 40.0) {
        return 0.5 * power * power;
    }
    power *= power;
    return 0.5 * (power + 1.0 / power);
}

//@ tanh
double expm1(double x);
double fabs(double x);

double tanh(double x)
{
    double power = fabs(x);
    power = power > 20.0 ? 1.0 : expm1(2.0 * power);
    power = fabs(x) > 20.0 ? power : power / (power + 2.0);
    return x < 0.0 ? -power : power;
}

//@ hypot
double fabs(double x);
double sqrt(double x);

double hypot(double x, double y)
{
    double large = fabs(x), small = fabs(y), ratio;
    if (large < small) {
        ratio = large;
        large = small;
        small = ratio;
    }
    if (large == 0.0 || large - large != 0.0) {
        return large + small;
    }
    ratio = small / large;
    return large * sqrt(1.0 + ratio * ratio);
}

//@ rsqrt
double sqrt(double x);

double rsqrt(double x) { return 1.0 / sqrt(x); }

//@ sinhf
double sinh(double x);

float sinhf(float x) { return (float)sinh(x); }

//@ coshf
double cosh(double x);

float coshf(float x) { return (float)cosh(x); }

//@ tanhf
double tanh(double x);

float tanhf(float x) { return (float)tanh(x); }

//@ hypotf
double hypot(double x, double y);

float hypotf(float x, float y) { return (float)hypot(x, y); }

//@ rsqrtf
double rsqrt(double x);

float rsqrtf(float x) { return (float)rsqrt(x); }
