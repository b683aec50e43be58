//@ prints: 3.0000 0.8415 0.5403 2.7183 1.5000 0.0000
//@ prints: 3.0000 0.8415 0.7854 2.5000 2.5000
#include "KMotionDef.h"

main()
{
    printf("%.4f %.4f %.4f %.4f %.4f %.4f\n", sqrt(9.0), sin(1.0), cos(1.0), exp(1.0), fast_fabs(-1.5), log(1.0));
    printf("%.4f %.4f %.4f %.4f %.4f\n", sqrtf(9.0f), sinf(1.0f), atan2f(1.0f, 1.0f), fast_fabsf(-2.5f), fast_fabs(-2.5));
}
//@ cycles: 47470
