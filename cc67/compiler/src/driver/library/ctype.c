// Kinds of characters: what the firmware lacks of <ctype.h>. Its own isspace is not repeated.

//@ isdigit
int isdigit(int c) { return c >= '0' && c <= '9'; }

//@ isupper
int isupper(int c) { return c >= 'A' && c <= 'Z'; }

//@ islower
int islower(int c) { return c >= 'a' && c <= 'z'; }

//@ isalpha
int isalpha(int c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

//@ isalnum
int isalnum(int c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

//@ isxdigit
int isxdigit(int c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'F') || (c >= 'a' && c <= 'f'); }

//@ isprint
int isprint(int c) { return c >= ' ' && c <= '~'; }

//@ isgraph
int isgraph(int c) { return c > ' ' && c <= '~'; }

//@ iscntrl
int iscntrl(int c) { return (c >= 0 && c < ' ') || c == 127; }

//@ isblank
int isblank(int c) { return c == ' ' || c == '\t'; }

//@ isascii
int isascii(int c) { return c >= 0 && c <= 127; }

//@ ispunct
int isalnum(int c);

int ispunct(int c) { return c > ' ' && c <= '~' && !isalnum(c); }

//@ toupper
int toupper(int c) { return c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c; }

//@ tolower
int tolower(int c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; }
