//@ exit: 1
#warning check the speeds
//~^ warning: check the speeds
#error no such machine
//~^ error: no such machine

main() { }
