#define ONLY_SECOND "found"
