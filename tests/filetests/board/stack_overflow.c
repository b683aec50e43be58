//@ exit: 3
//@ says: stack
deeper(int n) { int room[64]; room[0] = n; return deeper(n + 1) + room[0]; }
main() { deeper(0); }
//@ cycles: 1086
