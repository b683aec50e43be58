#define FOUND "found"
