int square(int x) { return x * x; }
int cube_plus(int x, int y) { return x * square(x) + y; }
