/* Threads that share out the items of a loop and sleep in between. Those of OpenMP spin while they wait, which takes
 * the processor away from the thread that reads the next block. */
#ifndef WEFT_BASE_THREAD_POOL_H
#define WEFT_BASE_THREAD_POOL_H

#include "base/status.h"

typedef struct weft_thread_pool weft_thread_pool;

/* One item; `thread` is 0 to thread_count - 1. */
typedef void weft_thread_pool_task(void *context, long item, int thread);

/* thread_count >= 1, the caller of weft_thread_pool_run among them. Errors: WEFT_SYSTEM. */
weft_code weft_thread_pool_create(int thread_count, weft_thread_pool **result, weft_error *error);

/* Does items 0 to count - 1, each once, in any order, and returns when all are done. One caller at a time. */
void weft_thread_pool_run(weft_thread_pool *pool, weft_thread_pool_task *task, void *context, long count);

/* NULL is fine. */
void weft_thread_pool_free(weft_thread_pool *pool);

#endif
