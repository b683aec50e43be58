//@ exit: 1
int a = 123abc; //~ error: suffix `abc`
double b = 1.2.3; //~ error: suffix `.3`
double c = 1.5abc; //~ error: suffix `abc`

main() { }
