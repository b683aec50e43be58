//@ exit: 1
#include <nosuch.h>
//~^ error: nosuch.h

main() { }
