/* How much memory there is, and how much this process has taken. */
#ifndef WEFT_COMPRESS_MEMORY_H
#define WEFT_COMPRESS_MEMORY_H

#include <stdint.h>

/* A quarter of what this process may have: of the physical memory or of the smallest limit among its control groups
 * (cgroup v1 and v2), whichever is less. */
uint64_t weft_memory_default(void);

/* Bytes of the process in physical memory. 0 where /proc is missing. */
uint64_t weft_memory_resident(void);

/* Bytes that malloc has handed out and not got back, touched or not. */
uint64_t weft_memory_allocated(void);

#endif
