/* What a suite is told on the command line. Each file test_NAME.c is a suite: a function `int test_NAME(void)` that
 * runs its tests and returns how many failed. */
#ifndef WEFT_TESTS_SUPPORT_SUITE_H
#define WEFT_TESTS_SUPPORT_SUITE_H

/* The word after the suite's name, or NULL. */
extern const char *suite_argument;

#endif
