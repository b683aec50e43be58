//@ exit: 1
int a = 20s; //~ error: suffix `s`
int b = 20x; //~ error: suffix `x`
int c = 0x12G; //~ error: suffix `G`

main() { }
