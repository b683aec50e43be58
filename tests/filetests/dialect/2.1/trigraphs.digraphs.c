//@ exit: 1
int a<:3:>; //~ error: expected `;`

main() { }
