//@ exit: 1
//@ says: a leading 0 makes a number octal
double fine = 08.5, zero = 00000;
int a = 08; //~ error: digit `8`
int b = 019; //~ error: digit `9`

main() { }
