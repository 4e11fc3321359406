/* A command that is killed, or finds the disk full. The test is compiled with WEFT_PROGRAM, the path of the program. */
#ifndef WEFT_TESTS_DISTURBED_COMMAND_H
#define WEFT_TESTS_DISTURBED_COMMAND_H

#include <stdbool.h>
#include <sys/resource.h>
#include <sys/types.h>

enum { DISTURBED_SAID = 8192 };

typedef struct disturbance {
    const char *watched; /* a file that grows while the command works */
    off_t kill_at;       /* bytes of it at which the command is killed; 0: never */
    rlim_t largest_file; /* bytes that no file exceeds, as on a disk that is full then; 0: none */
} disturbance;

typedef struct disturbed {
    int status; /* as waitpid gives it */
    long peak_kb;
    char said[DISTURBED_SAID]; /* both streams */
} disturbed;

/* Runs weft; the last argument is NULL. What it says passes through the file `disturbed.log`. A failure to run it ends
 * the test. */
disturbed run_disturbed(const char *const *argument, disturbance how);

/* Bytes of a file, -1 where there is none. */
off_t size_of(const char *name);

/* They end the test where it is not so. */
void expect_says(const disturbed *got, int code, const char *what);
void expect_not_said(const disturbed *got, const char *what);
void expect_same_bytes(const char *one, const char *two);

#endif
