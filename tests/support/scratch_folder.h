/* A folder of its own for each test program, and the disturbances that tests of files need. */
#ifndef WEFT_TESTS_SUPPORT_SCRATCH_FOLDER_H
#define WEFT_TESTS_SUPPORT_SCRATCH_FOLDER_H

#include <stddef.h>

/* cmocka group fixtures: enter a new folder, leave and remove it. SIGXFSZ is ignored, as the program does. */
int scratch_folder_enter(void **state);
int scratch_folder_leave(void **state);

/* Names in the folder, hidden ones included. */
int scratch_folder_entries(void);

/* Files cannot grow beyond `bytes` from now on; 0 lifts the limit. */
void scratch_limit_file_size(size_t bytes);

/* Whole files; failure ends the test. The caller frees what is loaded. */
unsigned char *scratch_load(const char *path, size_t *size);
void scratch_store(const char *path, const void *bytes, size_t size);

#endif
