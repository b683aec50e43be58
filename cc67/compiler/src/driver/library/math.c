// What the firmware lacks of <math.h>. Its own functions do the rest.

//@ fabs
double fabs(double x)
{
    ((unsigned *)&x)[1] &= 0x7fffffff;
    return x;
}

//@ fabsf
float fabsf(float x)
{
    *(unsigned *)&x &= 0x7fffffff;
    return x;
}

//@ trunc
double trunc(double x)
{
    unsigned *half = (unsigned *)&x;
    int exponent = (int)(half[1] >> 20 & 0x7ff) - 1023;
    if (exponent < 0) {
        half[1] &= 0x80000000;
        half[0] = 0;
    } else if (exponent < 20) {
        half[1] &= ~(0xfffff >> exponent);
        half[0] = 0;
    } else if (exponent < 52) {
        half[0] &= ~(0xffffffff >> (exponent - 20));
    }
    return x;
}

//@ truncf
double trunc(double x);

float truncf(float x) { return (float)trunc(x); }

//@ floor
double trunc(double x);

double floor(double x)
{
    double whole = trunc(x);
    return whole > x ? whole - 1.0 : whole;
}

//@ floorf
double floor(double x);

float floorf(float x) { return (float)floor(x); }

//@ ceil
double floor(double x);

double ceil(double x) { return -floor(-x); }

//@ ceilf
double floor(double x);

float ceilf(float x) { return -(float)floor(-x); }

//@ round
double trunc(double x);

double round(double x)
{
    double whole = trunc(x), rest = x - whole;
    if (rest >= 0.5) {
        return whole + 1.0;
    }
    return rest <= -0.5 ? whole - 1.0 : whole;
}

//@ roundf
double round(double x);

float roundf(float x) { return (float)round(x); }

//@ rint
double floor(double x);

double rint(double x)
{
    double low = floor(x), rest = x - low;
    if (rest < 0.5 || (rest == 0.5 && floor(low / 2.0) * 2.0 == low)) {
        return low;
    }
    return low + 1.0;
}

//@ nearbyint
double rint(double x);

double nearbyint(double x) { return rint(x); }

//@ lround
double round(double x);

long lround(double x) { return (long)round(x); }

//@ lrint
double rint(double x);

long lrint(double x) { return (long)rint(x); }

//@ fmod
// By subtraction of shifted divisors, which is exact.
double fabs(double x);
double ldexp(double x, int n);
double frexp(double x, int *exponent);

double fmod(double x, double y)
{
    double rest = fabs(x), step, divisor = fabs(y);
    int upper, lower;
    if (!(divisor > 0.0) || !(rest - rest == 0.0)) {
        return 0.0 * x / (0.0 * y);
    }
    if (divisor - divisor != 0.0) {
        return x;
    }
    frexp(rest, &upper);
    frexp(divisor, &lower);
    for (; rest >= divisor && upper >= lower; upper--) {
        step = ldexp(divisor, upper - lower);
        if (rest >= step) {
            rest -= step;
        }
    }
    return x < 0.0 ? -rest : rest;
}

//@ fmodf
double fmod(double x, double y);

float fmodf(float x, float y) { return (float)fmod(x, y); }

//@ copysign
double copysign(double x, double sign)
{
    unsigned *half = (unsigned *)&x + 1;
    *half = (*half & 0x7fffffff) | (((unsigned *)&sign)[1] & 0x80000000);
    return x;
}

//@ copysignf
float copysignf(float x, float sign)
{
    *(unsigned *)&x = (*(unsigned *)&x & 0x7fffffff) | (*(unsigned *)&sign & 0x80000000);
    return x;
}

//@ fmin
int __float_class(double x);

double fmin(double x, double y) { return x < y || __float_class(y) == 0 ? x : y; }

//@ fmax
int __float_class(double x);

double fmax(double x, double y) { return x > y || __float_class(y) == 0 ? x : y; }

//@ fminf
int __float_class(double x);

float fminf(float x, float y) { return x < y || __float_class(y) == 0 ? x : y; }

//@ fmaxf
int __float_class(double x);

float fmaxf(float x, float y) { return x > y || __float_class(y) == 0 ? x : y; }

//@ cbrt
double pow(double x, double y);

double cbrt(double x)
{
    double root;
    if (x == 0.0) {
        return x;
    }
    root = x < 0.0 ? -pow(-x, 1.0 / 3.0) : pow(x, 1.0 / 3.0);
    return root - (root * root * root - x) / (3.0 * root * root);
}

//@ __float_class
// 0 not a number, 1 infinite, 2 zero, 3 denormal, 4 any other.
int __float_class(double x)
{
    unsigned *half = (unsigned *)&x;
    unsigned exponent = half[1] >> 20 & 0x7ff, rest = (half[1] & 0xfffff) | half[0];
    if (exponent == 0x7ff) {
        return rest == 0;
    }
    return exponent ? 4 : rest ? 3 : 2;
}

//@ __float_sign
int __float_sign(double x)
{
    return ((unsigned *)&x)[1] >> 31;
}
