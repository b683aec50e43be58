#define NESTED "nested"
