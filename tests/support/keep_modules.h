/* For leak checkers. */
#ifndef WEFT_TESTS_KEEP_MODULES_H
#define WEFT_TESTS_KEEP_MODULES_H

/* Keeps every library that is loaded now until the process ends. Graphics drivers unload themselves and their compiler
 * with the last context; what they leaked could then no longer be told from our own leaks (tests/sanitizers/lsan.supp).
 */
void keep_modules_loaded(void);

#endif
