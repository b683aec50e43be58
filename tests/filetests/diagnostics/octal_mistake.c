//@ exit: 1
//@ snapshot
int delay = 08;
main() { }
