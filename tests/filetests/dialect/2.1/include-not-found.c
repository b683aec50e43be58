//@ args: run -I parts/first
//@ exit: 1
//@ says: parts/first
//@ says: where_else.h
#include "where_els.h"
//~^ error: where_els.h

main() { }
