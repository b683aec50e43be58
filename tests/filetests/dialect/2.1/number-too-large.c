//@ exit: 1
double a = 18446744073709551616; //~ error: does not fit 64 bits

main() { }
