/* Expectations of programs of tests, in the common part of C11 and C++17. */
#ifndef SUBSURF_TESTS_EXPECT_H
#define SUBSURF_TESTS_EXPECT_H

#include "subsurf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(condition)                                                                        \
    do {                                                                                         \
        if (!(condition)) {                                                                      \
            fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, __LINE__, #condition, subsurf_last_error()); \
            exit(1);                                                                             \
        }                                                                                        \
    } while (0)
#define OK(call) EXPECT((call) == SUBSURF_STATUS_OK)
/* The text of a failure has these words, and is one line. */
#define FAILS(status, words, call)                                                               \
    do {                                                                                         \
        EXPECT((call) == SUBSURF_STATUS_##status);                                               \
        EXPECT(strstr(subsurf_last_error(), words) != NULL);                                     \
        EXPECT(strchr(subsurf_last_error(), '\n') == NULL);                                      \
    } while (0)

#endif
