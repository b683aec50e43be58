//@ exit: 1
int a = 'ab'; //~ error: more than one
int b = ''; //~ error: empty

main() { }
