//@ exit: 1
//@ says: no `main`
;
