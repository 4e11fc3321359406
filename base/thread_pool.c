#include "base/thread_pool.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct member {
    weft_thread_pool *pool;
    int thread;
    pthread_t handle;
} member;

struct weft_thread_pool {
    member *member; /* [member_count], all but the caller */
    int member_count;
    /* Set before a run begins. */
    weft_thread_pool_task *task;
    void *context;
    long count;
    atomic_long next;
    /* Below: under the mutex. */
    pthread_mutex_t mutex;
    pthread_cond_t begun, ended;
    unsigned run; /* number of the present one */
    int busy;     /* members still at it */
    bool over;
};

static void do_items(weft_thread_pool *pool, int thread)
{
    for (long item; (item = atomic_fetch_add(&pool->next, 1)) < pool->count;)
        pool->task(pool->context, item, thread);
}

/* False when there is nothing more to come. */
static bool wait_for_run(weft_thread_pool *pool, unsigned *seen)
{
    pthread_mutex_lock(&pool->mutex);
    while (pool->run == *seen && !pool->over)
        pthread_cond_wait(&pool->begun, &pool->mutex);
    *seen = pool->run;
    bool go_on = !pool->over;
    pthread_mutex_unlock(&pool->mutex);
    return go_on;
}

static void *work(void *context)
{
    const member *self = context;
    weft_thread_pool *pool = self->pool;
    for (unsigned seen = 0; wait_for_run(pool, &seen);) {
        do_items(pool, self->thread);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->busy == 0)
            pthread_cond_signal(&pool->ended);
        pthread_mutex_unlock(&pool->mutex);
    }
    return NULL;
}

static weft_code start_members(weft_thread_pool *pool, int count, weft_error *error)
{
    pool->member = calloc((size_t)count + 1, sizeof *pool->member);
    if (!pool->member)
        return weft_fail_memory(error, "threads", (size_t)count * sizeof *pool->member);
    for (int i = 0; i < count; i++) {
        member *one = &pool->member[i];
        *one = (member){.pool = pool, .thread = i + 1};
        int failure = pthread_create(&one->handle, NULL, work, one);
        if (failure != 0)
            return weft_fail(error, WEFT_SYSTEM, "cannot start thread %d of %d: %s", i + 2, count + 1,
                             strerror(failure));
        pool->member_count++;
    }
    return WEFT_OK;
}

weft_code weft_thread_pool_create(int thread_count, weft_thread_pool **result, weft_error *error)
{
    *result = NULL;
    weft_thread_pool *pool = calloc(1, sizeof *pool);
    if (!pool)
        return weft_fail_memory(error, "threads", sizeof *pool);
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->begun, NULL);
    pthread_cond_init(&pool->ended, NULL);
    weft_code code = start_members(pool, thread_count - 1, error);
    if (code == WEFT_OK)
        *result = pool;
    else
        weft_thread_pool_free(pool);
    return code;
}

void weft_thread_pool_run(weft_thread_pool *pool, weft_thread_pool_task *task, void *context, long count)
{
    pthread_mutex_lock(&pool->mutex);
    pool->task = task;
    pool->context = context;
    pool->count = count;
    atomic_store(&pool->next, 0);
    pool->busy = pool->member_count;
    pool->run++;
    pthread_cond_broadcast(&pool->begun);
    pthread_mutex_unlock(&pool->mutex);
    do_items(pool, 0);
    pthread_mutex_lock(&pool->mutex);
    while (pool->busy > 0)
        pthread_cond_wait(&pool->ended, &pool->mutex);
    pthread_mutex_unlock(&pool->mutex);
}

void weft_thread_pool_free(weft_thread_pool *pool)
{
    if (!pool)
        return;
    pthread_mutex_lock(&pool->mutex);
    pool->over = true;
    pthread_cond_broadcast(&pool->begun);
    pthread_mutex_unlock(&pool->mutex);
    for (int i = 0; i < pool->member_count; i++)
        pthread_join(pool->member[i].handle, NULL);
    pthread_cond_destroy(&pool->begun);
    pthread_cond_destroy(&pool->ended);
    pthread_mutex_destroy(&pool->mutex);
    free(pool->member);
    free(pool);
}
