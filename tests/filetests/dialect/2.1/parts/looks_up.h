// The name is written as seen from the main file's folder.
#include "parts/first/found.h"
