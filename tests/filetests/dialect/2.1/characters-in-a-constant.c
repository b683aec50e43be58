//@ exit: 1
int a = 'ab'; //~ error
int b = ''; //~ error

main() { }
