//@ exit: 1
//@ says: 64
#include "parts/itself.h"

main() { }
