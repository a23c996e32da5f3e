/* A host as the program's platform. */
#include <stdio.h>

void put(const char *text);

void put(const char *text) {
    fputs(text, stdout);
}
