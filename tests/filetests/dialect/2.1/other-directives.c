//@ exit: 1
# 33 "x"
# 5 "other-directives.c"
#import "x.h" //~ error: import
#foo //~ error: foo

main() { }
