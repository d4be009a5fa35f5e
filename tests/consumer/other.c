// Another language in a target that links the library.
int other(void) { return 0; }
