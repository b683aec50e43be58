// The standard headers are there, beside the header of the board.
//@ prints: 3 4 -2 7 5 hello 12.500000
//@ prints: 9223372036854775807 1 1 2.000000 4294967295
#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <iso646.h>
#include <limits.h>
#include <math.h>
#include <stdalign.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <stdnoreturn.h>
#include <string.h>
#include "KMotionDef.h"

static int sum(int count, ...)
{
    va_list list;
    int total = 0;
    va_start(list, count);
    while (count-- > 0) {
        total += va_arg(list, int);
    }
    va_end(list);
    return total;
}

main()
{
    char text[20];
    double back;
    size_t size = offsetof(struct { char c; int i; }, i);
    assert(size == 4 and not false);
    strcpy(text, "hel");
    strcat(text, "lo");
    sscanf("12.5", "%lf", &back);
    printf("%d %u %d %d %d %s %f\n", abs(-3), size, (int)floor(-1.5), sum(2, 3, 4), (int)strlen(text), text, back);
    errno = isnan(NAN);
    printf("%" PRId64 " %d %d %f %" PRIu32 "\n", INT64_MAX, errno, isupper('A'), fmax(1.0, 2.0), UINT32_MAX);
}
//@ cycles: 41377
