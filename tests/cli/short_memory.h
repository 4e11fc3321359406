/* Makes chosen allocations of Weft fail. The linker sends every allocation that Weft's own objects ask for (--wrap,
 * tests/cli/CMakeLists.txt) to short_memory.c, and jansson's, which tells its callers of a failure; those inside other
 * libraries stay as they are.
 *
 * An allocation is known by its site: the functions of Weft that were called when it was asked for, as a hash that is
 * the same in every run of one program and for any number of threads. */
#ifndef WEFT_TESTS_CLI_SHORT_MEMORY_H
#define WEFT_TESTS_CLI_SHORT_MEMORY_H

#include <stdatomic.h>
#include <stdint.h>

enum { SHORT_MEMORY_SITES = 1 << 14, SHORT_MEMORY_FRAMES = 6 };

typedef struct short_memory_site {
    _Atomic uint64_t hash;               /* 0: unused */
    _Atomic long count;                  /* allocations asked for here */
    uint32_t frame[SHORT_MEMORY_FRAMES]; /* return addresses, from the start of the program; 0 beyond the last */
} short_memory_site;

/* What is noted of a run. Lies in memory that both the process that runs and the one that waits for it see. */
typedef struct short_memory_log {
    _Atomic long count, failed; /* allocations asked for, and refused */
    long kept;                  /* never freed, at the time of short_memory_count_kept */
    uint32_t keeper[4];         /* return addresses of the first of those */
    short_memory_site site[SHORT_MEMORY_SITES];
} short_memory_log;

/* Which allocations fail. */
typedef struct short_memory_order {
    uint64_t site;   /* of this site only; 0: of any */
    long number;     /* the number-th there, from 1; 0: none */
    _Bool from_then; /* and all that are asked for later, wherever */
} short_memory_order;

/* Prepares the process, before any of its forks. */
void short_memory_prepare(void);

/* Begins to note and to fail, once a process. `log` is zeroed; its sites are filled where `order` fails nothing. */
void short_memory_begin(short_memory_log *log, short_memory_order order);

/* Stops failing, and counts what was asked for since the beginning and never freed. */
void short_memory_count_kept(void);

/* Whether the allocation that is asked for now has to fail; errno is then ENOMEM. `caller` is the return address of the
 * function that stands in for the allocator. */
_Bool short_memory_fails(const void *caller);

#endif
