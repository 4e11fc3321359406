#include "base/thread_pool.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct member {
    weft_crew *crew;
    int thread;
    pthread_t handle;
} member;

struct weft_crew {
    member *member; /* [member_count], all but the caller */
    int member_count;
    /* Set before a run begins. */
    weft_crew_task *task;
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

static void do_items(weft_crew *crew, int thread)
{
    for (long item; (item = atomic_fetch_add(&crew->next, 1)) < crew->count;)
        crew->task(crew->context, item, thread);
}

/* False when there is nothing more to come. */
static bool wait_for_run(weft_crew *crew, unsigned *seen)
{
    pthread_mutex_lock(&crew->mutex);
    while (crew->run == *seen && !crew->over)
        pthread_cond_wait(&crew->begun, &crew->mutex);
    *seen = crew->run;
    bool go_on = !crew->over;
    pthread_mutex_unlock(&crew->mutex);
    return go_on;
}

static void *work(void *context)
{
    const member *self = context;
    weft_crew *crew = self->crew;
    for (unsigned seen = 0; wait_for_run(crew, &seen);) {
        do_items(crew, self->thread);
        pthread_mutex_lock(&crew->mutex);
        if (--crew->busy == 0)
            pthread_cond_signal(&crew->ended);
        pthread_mutex_unlock(&crew->mutex);
    }
    return NULL;
}

static weft_code start_members(weft_crew *crew, int count, weft_error *error)
{
    crew->member = calloc((size_t)count + 1, sizeof *crew->member);
    if (!crew->member)
        return weft_fail_memory(error, "threads", (size_t)count * sizeof *crew->member);
    for (int i = 0; i < count; i++) {
        member *one = &crew->member[i];
        *one = (member){.crew = crew, .thread = i + 1};
        int failure = pthread_create(&one->handle, NULL, work, one);
        if (failure != 0)
            return weft_fail(error, WEFT_SYSTEM, "cannot start thread %d of %d: %s", i + 2, count + 1,
                             strerror(failure));
        crew->member_count++;
    }
    return WEFT_OK;
}

weft_code weft_crew_create(int thread_count, weft_crew **result, weft_error *error)
{
    *result = NULL;
    weft_crew *crew = calloc(1, sizeof *crew);
    if (!crew)
        return weft_fail_memory(error, "threads", sizeof *crew);
    pthread_mutex_init(&crew->mutex, NULL);
    pthread_cond_init(&crew->begun, NULL);
    pthread_cond_init(&crew->ended, NULL);
    weft_code code = start_members(crew, thread_count - 1, error);
    if (code == WEFT_OK)
        *result = crew;
    else
        weft_crew_free(crew);
    return code;
}

void weft_crew_run(weft_crew *crew, weft_crew_task *task, void *context, long count)
{
    pthread_mutex_lock(&crew->mutex);
    crew->task = task;
    crew->context = context;
    crew->count = count;
    atomic_store(&crew->next, 0);
    crew->busy = crew->member_count;
    crew->run++;
    pthread_cond_broadcast(&crew->begun);
    pthread_mutex_unlock(&crew->mutex);
    do_items(crew, 0);
    pthread_mutex_lock(&crew->mutex);
    while (crew->busy > 0)
        pthread_cond_wait(&crew->ended, &crew->mutex);
    pthread_mutex_unlock(&crew->mutex);
}

void weft_crew_free(weft_crew *crew)
{
    if (!crew)
        return;
    pthread_mutex_lock(&crew->mutex);
    crew->over = true;
    pthread_cond_broadcast(&crew->begun);
    pthread_mutex_unlock(&crew->mutex);
    for (int i = 0; i < crew->member_count; i++)
        pthread_join(crew->member[i].handle, NULL);
    pthread_cond_destroy(&crew->begun);
    pthread_cond_destroy(&crew->ended);
    pthread_mutex_destroy(&crew->mutex);
    free(crew->member);
    free(crew);
}
