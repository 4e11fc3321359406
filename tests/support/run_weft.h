/* Running the program as a user does. The test is compiled with WEFT_PROGRAM, the path of the program. */
#ifndef WEFT_TESTS_RUN_WEFT_H
#define WEFT_TESTS_RUN_WEFT_H

enum { RUN_WEFT_SAID = 8192 };

/* Runs weft with arguments for a shell, after `before`, which the shell does first ("" for nothing). What both outputs
 * say goes to `said`, as far as it fits. Returns the exit code; a crash ends the test. */
int run_weft(const char *before, const char *arguments, char said[RUN_WEFT_SAID]);

/* The same, and fails the test unless weft exits with `code` and says `what` among other things. */
void expect_weft_after(const char *before, const char *arguments, int code, const char *what);
void expect_weft(const char *arguments, int code, const char *what);

#endif
