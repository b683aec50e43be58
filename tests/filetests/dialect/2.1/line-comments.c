//@ prints: 5 //text
#include "KMotionDef.h" // behind a directive

//
main() // here
{ // and here
    printf("5 //text\n"); /* a // in it */ // ///
}
//@ cycles: 2092
