//@ prints: 2.0
#include <stdio.h>
#include <math.h>
#include <string.h>
#include <stdlib.h>
#include "KMotionDef.h"

main() { printf("%.1f\n", sqrt(4)); }
//@ cycles: 4081
