#define WHERE "beside"
#include "nested.h"
