/* How much memory there is, and how much this process has taken. */
#ifndef WEFT_COMPRESS_RUN_MEMORY_H
#define WEFT_COMPRESS_RUN_MEMORY_H

#include "base/status.h"

#include <stdint.h>

/* A quarter of what this process may have: of the physical memory or of the smallest limit among its control groups
 * (cgroup v1 and v2), whichever is less. */
uint64_t weft_memory_default(void);

/* Bytes of the process in physical memory. 0 where /proc is missing. */
uint64_t weft_memory_resident(void);

/* How much memory a computation may take. */
typedef struct weft_memory_budget {
    uint64_t limit;    /* of the whole process */
    uint64_t overhead; /* what is resident besides memory from malloc: code, libraries, stacks */
} weft_memory_budget;

/* limit 0 stands for weft_memory_default. Call it before anything large is allocated. */
weft_memory_budget weft_memory_budget_begin(uint64_t limit);

/* Bytes of the limit that are taken, counting all memory from malloc as if it had been touched. */
uint64_t weft_memory_budget_taken(const weft_memory_budget *budget);

/* That `bytes` more can be taken, for `what` of the file `path`. Errors: WEFT_BAD_USAGE saying how much would do. */
weft_code weft_memory_budget_require(const weft_memory_budget *budget, uint64_t bytes, const char *path,
                                     const char *what, weft_error *error);

#endif
