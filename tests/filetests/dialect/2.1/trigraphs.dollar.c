//@ exit: 1
//@ says: found the character `$`
int a$b; //~ error: expected `;`

main() { }
