#ifndef _MATH_H
#define _MATH_H
#define HUGE_VAL 1e400
#define HUGE_VALF ((float)1e400)
#define INFINITY ((float)1e400)
#define NAN (INFINITY - INFINITY)
#define FP_NAN 0
#define FP_INFINITE 1
#define FP_ZERO 2
#define FP_SUBNORMAL 3
#define FP_NORMAL 4
#define M_E 2.7182818284590452354
#define M_LOG2E 1.4426950408889634074
#define M_LOG10E 0.43429448190325182765
#define M_LN2 0.69314718055994530942
#define M_LN10 2.30258509299404568402
#define M_PI 3.14159265358979323846
#define M_PI_2 1.57079632679489661923
#define M_PI_4 0.78539816339744830962
#define M_1_PI 0.31830988618379067154
#define M_2_PI 0.63661977236758134308
#define M_SQRT2 1.41421356237309504880
#define M_SQRT1_2 0.70710678118654752440
typedef float float_t;
typedef double double_t;
int __float_class(double x);
int __float_sign(double x);
#define fpclassify(x) __float_class(x)
#define isnan(x) (__float_class(x) == FP_NAN)
#define isinf(x) (__float_class(x) == FP_INFINITE)
#define isfinite(x) (__float_class(x) >= FP_ZERO)
#define isnormal(x) (__float_class(x) == FP_NORMAL)
#define signbit(x) __float_sign(x)
double sqrt(double x);
float sqrtf(float x);
double exp(double x);
float expf(float x);
double exp2(double x);
float exp2f(float x);
double exp10(double x);
float exp10f(float x);
double log(double x);
float logf(float x);
double log2(double x);
float log2f(float x);
double log10(double x);
float log10f(float x);
double sin(double x);
float sinf(float x);
double cos(double x);
float cosf(float x);
double tan(double x);
float tanf(float x);
double asin(double x);
float asinf(float x);
double acos(double x);
float acosf(float x);
double atan(double x);
float atanf(float x);
double sinh(double x);
float sinhf(float x);
double cosh(double x);
float coshf(float x);
double tanh(double x);
float tanhf(float x);
double fabs(double x);
float fabsf(float x);
double floor(double x);
float floorf(float x);
double ceil(double x);
float ceilf(float x);
double round(double x);
float roundf(float x);
double trunc(double x);
float truncf(float x);
double pow(double x, double y);
float powf(float x, float y);
double atan2(double x, double y);
float atan2f(float x, float y);
double fmod(double x, double y);
float fmodf(float x, float y);
double hypot(double x, double y);
float hypotf(float x, float y);
double copysign(double x, double y);
float copysignf(float x, float y);
double fmin(double x, double y);
float fminf(float x, float y);
double fmax(double x, double y);
float fmaxf(float x, float y);
double cbrt(double x);
double rint(double x);
double nearbyint(double x);
long lrint(double x);
long lround(double x);
double modf(double x, double *whole);
float modff(float x, float *whole);
double frexp(double x, int *exponent);
float frexpf(float x, int *exponent);
double ldexp(double x, int exponent);
float ldexpf(float x, int exponent);
double log1p(double x);
float log1pf(float x);
double expm1(double x);
float expm1f(float x);
double asinh(double x);
float asinhf(float x);
double acosh(double x);
float acoshf(float x);
double atanh(double x);
float atanhf(float x);
double erf(double x);
float erff(float x);
double erfc(double x);
float erfcf(float x);
double tgamma(double x);
float tgammaf(float x);
double lgamma(double x);
float lgammaf(float x);
double logb(double x);
float logbf(float x);
float cbrtf(float x);
float rintf(float x);
float nearbyintf(float x);
double remainder(double x, double y);
float remainderf(float x, float y);
double nextafter(double x, double y);
float nextafterf(float x, float y);
double fdim(double x, double y);
float fdimf(float x, float y);
double remquo(double x, double y, int *quotient);
float remquof(float x, float y, int *quotient);
double fma(double x, double y, double z);
float fmaf(float x, float y, float z);
double nan(const char *tag);
float nanf(const char *tag);
double scalbn(double x, int exponent);
float scalbnf(float x, int exponent);
double scalbln(double x, long exponent);
float scalblnf(float x, long exponent);
int ilogb(double x);
int ilogbf(float x);
long lrintf(float x);
long lroundf(float x);
long long llrint(double x);
long long llrintf(float x);
long long llround(double x);
long long llroundf(float x);
#define FP_ILOGB0 (-0x7fffffff)
#define FP_ILOGBNAN 0x7fffffff
#define isgreater(x, y) ((x) > (y))
#define isgreaterequal(x, y) ((x) >= (y))
#define isless(x, y) ((x) < (y))
#define islessequal(x, y) ((x) <= (y))
#define islessgreater(x, y) ((x) < (y) || (x) > (y))
#define isunordered(x, y) (isnan(x) || isnan(y))
// `long double` is `double`.
#define acosl acos
#define asinl asin
#define atanl atan
#define atan2l atan2
#define cosl cos
#define sinl sin
#define tanl tan
#define acoshl acosh
#define asinhl asinh
#define atanhl atanh
#define coshl cosh
#define sinhl sinh
#define tanhl tanh
#define expl exp
#define exp2l exp2
#define expm1l expm1
#define frexpl frexp
#define ilogbl ilogb
#define ldexpl ldexp
#define logl log
#define log10l log10
#define log1pl log1p
#define log2l log2
#define logbl logb
#define modfl modf
#define scalbnl scalbn
#define scalblnl scalbln
#define cbrtl cbrt
#define fabsl fabs
#define hypotl hypot
#define powl pow
#define sqrtl sqrt
#define erfl erf
#define erfcl erfc
#define lgammal lgamma
#define tgammal tgamma
#define ceill ceil
#define floorl floor
#define nearbyintl nearbyint
#define rintl rint
#define lrintl lrint
#define llrintl llrint
#define roundl round
#define lroundl lround
#define llroundl llround
#define truncl trunc
#define fmodl fmod
#define remainderl remainder
#define remquol remquo
#define copysignl copysign
#define nanl nan
#define nextafterl nextafter
#define fdiml fdim
#define fmaxl fmax
#define fminl fmin
#define fmal fma
#define nexttoward nextafter
#define nexttowardf(x, y) nextafterf(x, (float)(y))
#define nexttowardl nextafter
#endif
