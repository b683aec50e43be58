// What C99 adds to <math.h> is compiled from the library, on every engine.
//@ prints: 0.693147 1e-10 1.71828 1e-10 -1
//@ prints: 0.881374 1.31696 0.549306 -0.881374
//@ prints: 0.842701 0.157299 0.999978 2.20905e-05 -0.842701
//@ prints: 24 1.77245 3.62561 -3.54491 2.45374 0
//@ prints: 3 -2 7 1.5 12 -4e+09
//@ prints: -1 3 1 -0.5 0 2.5
//@ prints: 1 0 1.0000001 1 0 1
//@ prints: 2.12928 2.35241 0.905148 5 0.5 1 -1
//@ prints: 10 8 1e-17 1
//@ prints: ab [x=5] [1.50 7] 6
#include "KMotionDef.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

int quotient;

int say(char *to, const char *format, ...)
{
    va_list values;
    int length;
    va_start(values, format);
    length = vsprintf(to, format, values);
    va_end(values);
    return length;
}

main()
{
    char a[40], b[40];
    double next = nextafter(1.0, 2.0), rest;
    printf("%g %g %g %g %g\n", log1p(1.0), log1p(1e-10), expm1(1.0), expm1(1e-10), expm1(-50.0));
    printf("%g %g %g %g\n", asinh(1.0), acosh(2.0), atanh(0.5), asinhf(-1.0f));
    printf("%g %g %g %g %g\n", erf(1.0), erfc(1.0), erf(3.0), erfc(3.0), erff(-1.0f));
    printf("%g %g %g %g %g %g\n", tgamma(5.0), tgamma(0.5), tgamma(0.25), tgamma(-0.5), lgamma(4.5), lgamma(2.0));
    printf("%d %d %d %g %g %g\n", ilogb(8.5), ilogb(0.25), (int)logb(200.0), scalbn(0.75, 1), scalbln(3.0, 2),
           (double)llround(-4e9 - 0.25));
    rest = remquo(-7.5, 2.0, &quotient);
    printf("%g %d %d %g %g %g\n", remainder(5.0, 3.0), (int)remainderf(11.0f, 4.0f) + 4, quotient + 5, rest - 1.0, fdim(1.0, 2.0),
           fdim(4.0, 1.5));
    printf("%d %g %.8g %d %d %d\n", next > 1.0 && (next + 1.0) / 2.0 == 1.0, nextafter(0.0, 1.0) * 1.0, (double)nextafterf(1.0f, 2.0f),
           isnan(nan("")), isunordered(1.0, 2.0), islessgreater(1.0, 2.0));
    printf("%g %g %g %g %g %g %g\n", sinh(1.5), cosh(1.5), tanhf(1.5f), hypot(3.0, -4.0), 1.0 / sqrtl(4.0L), tanh(30.0), tanh(-30.0));
    printf("%g %g %g %d\n", fma(2.0, 3.0, 4.0), fmaf(2.0f, 3.0f, 2.0f), fma(1e-17, 1.0, 0.0),
           fma(1.0 + 1.0 / 134217728, 1.0 - 1.0 / 134217728, -1.0) == -1.0 / 134217728 / 134217728);
    putchar('a');
    snprintf(a, 40, "[x=%d]", 5);
    quotient = say(b, "[%.2f %d]", 1.5, 7);
    printf("b %s %s %d\n", a, b, quotient - 2);
}
