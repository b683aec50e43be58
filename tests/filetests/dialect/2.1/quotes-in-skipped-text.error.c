//@ exit: 1
#error it doesn't work
//~^ error: it doesn't work

main() { }
