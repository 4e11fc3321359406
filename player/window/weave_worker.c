#include "player/window/weave_worker.h"

#include "reflectance/weave/batch.h"

#include <pthread.h>
#include <stdlib.h>
#include <time.h>

/* So long after the last change the exact scale is computed: while a slider moves nobody waits for it. */
enum { REST_MS = 150 };

struct weft_weave_worker {
    pthread_t thread;
    double correction; /* of estimated scales; the thread's alone once it runs */
    pthread_mutex_t mutex;
    pthread_cond_t asked;
    /* Guarded: */
    bool stops, has_wish, has_news, exact;
    long wish_number; /* of the last wish, taken up or not; they count from 1 */
    long news_number; /* of the wish that `news` and `exact` answer */
    weft_weave wish;
    weft_weave_texels news;
    weft_code code; /* of what failed last */
    weft_error error;
};

/* ---- The thread ---- */

static void publish(weft_weave_worker *w, const weft_weave *weave, long number, bool exact, weft_code code,
                    weft_error *error)
{
    weft_weave_texels texels = {0};
    if (code == WEFT_OK)
        code = weft_weave_texels_of(weave, &texels, error);
    pthread_mutex_lock(&w->mutex);
    weft_weave_texels_free(&w->news);
    w->news = texels;
    w->has_news = true;
    w->news_number = number;
    w->exact = exact;
    w->code = code;
    w->error = *error;
    pthread_mutex_unlock(&w->mutex);
}

static weft_real estimated_scale(weft_weave_worker *w, weft_weave *weave, weft_real *estimate, weft_code *code,
                                 weft_error *error)
{
    *estimate = 0;
    *code = weft_weave_specular_scale_batch(weave, estimate, error);
    return *estimate * (weft_real)w->correction;
}

/* Holding the mutex; false once another weave is wanted or all ends. */
static bool is_left_alone(weft_weave_worker *w)
{
    struct timespec end;
    clock_gettime(CLOCK_REALTIME, &end);
    long nanoseconds = end.tv_nsec + REST_MS * 1000000L;
    end.tv_sec += nanoseconds / 1000000000L;
    end.tv_nsec = nanoseconds % 1000000000L;
    int status = 0;
    while (!w->stops && !w->has_wish && status == 0)
        status = pthread_cond_timedwait(&w->asked, &w->mutex, &end);
    return !w->stops && !w->has_wish;
}

static void derive(weft_weave_worker *w, weft_weave *weave, long number)
{
    weft_error error = {0};
    weft_code code;
    weft_real estimate;
    weft_weave_update_yarns(weave);
    weave->specular_scale = estimated_scale(w, weave, &estimate, &code, &error);
    publish(w, weave, number, false, code, &error);
    pthread_mutex_lock(&w->mutex);
    bool goes_on = is_left_alone(w);
    pthread_mutex_unlock(&w->mutex);
    if (!goes_on || code != WEFT_OK)
        return;
    weave->specular_scale = weft_weave_specular_scale(weave);
    if (estimate > 0)
        w->correction = (double)(weave->specular_scale / estimate);
    publish(w, weave, number, true, WEFT_OK, &error);
}

static void *run(void *context)
{
    weft_weave_worker *w = context;
    pthread_mutex_lock(&w->mutex);
    while (!w->stops) {
        if (!w->has_wish) {
            pthread_cond_wait(&w->asked, &w->mutex);
            continue;
        }
        weft_weave weave = w->wish;
        long number = w->wish_number;
        w->wish = (weft_weave){0};
        w->has_wish = false;
        pthread_mutex_unlock(&w->mutex);
        derive(w, &weave, number);
        weft_weave_free(&weave);
        pthread_mutex_lock(&w->mutex);
    }
    pthread_mutex_unlock(&w->mutex);
    return NULL;
}

/* ---- The drawing thread ---- */

weft_code weft_weave_worker_create(const weft_weave *start, weft_weave_worker **result, weft_error *error)
{
    *result = NULL;
    weft_real estimate;
    WEFT_TRY(weft_weave_specular_scale_batch(start, &estimate, error));
    weft_weave_worker *w = calloc(1, sizeof *w);
    if (!w)
        return weft_fail_memory(error, "weave", sizeof *w);
    w->correction = estimate > 0 ? (double)(start->specular_scale / estimate) : 1;
    pthread_mutex_init(&w->mutex, NULL);
    pthread_cond_init(&w->asked, NULL);
    if (pthread_create(&w->thread, NULL, run, w) != 0) {
        pthread_cond_destroy(&w->asked);
        pthread_mutex_destroy(&w->mutex);
        free(w);
        return weft_fail(error, WEFT_SYSTEM, "cannot start a thread for the weave");
    }
    *result = w;
    return WEFT_OK;
}

void weft_weave_worker_free(weft_weave_worker *w)
{
    if (!w)
        return;
    pthread_mutex_lock(&w->mutex);
    w->stops = true;
    pthread_cond_signal(&w->asked);
    pthread_mutex_unlock(&w->mutex);
    pthread_join(w->thread, NULL);
    weft_weave_free(&w->wish);
    weft_weave_texels_free(&w->news);
    pthread_cond_destroy(&w->asked);
    pthread_mutex_destroy(&w->mutex);
    free(w);
}

weft_code weft_weave_worker_ask(weft_weave_worker *w, const weft_weave *weave, weft_error *error)
{
    weft_weave copy;
    WEFT_TRY(weft_weave_copy(weave, &copy, error));
    pthread_mutex_lock(&w->mutex);
    weft_weave_free(&w->wish);
    w->wish = copy;
    w->wish_number++;
    w->has_wish = true;
    pthread_cond_signal(&w->asked);
    pthread_mutex_unlock(&w->mutex);
    return WEFT_OK;
}

weft_code weft_weave_worker_take(weft_weave_worker *w, weft_weave_texels *texels, bool *ready, bool *exact,
                                 weft_error *error)
{
    pthread_mutex_lock(&w->mutex);
    weft_code code = w->has_news ? w->code : WEFT_OK;
    if (code != WEFT_OK)
        weft_error_set(error, code, "%s", w->error.message);
    *ready = w->has_news && code == WEFT_OK;
    *exact = w->exact && w->news_number == w->wish_number;
    *texels = (weft_weave_texels){0};
    if (*ready) {
        *texels = w->news;
        w->news = (weft_weave_texels){0};
    }
    w->has_news = false;
    pthread_mutex_unlock(&w->mutex);
    return code;
}
