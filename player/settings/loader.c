#include "player/settings/loader.h"

#include "base/clock.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

static const size_t most_bytes_waiting = (size_t)64 << 20;

typedef struct piece {
    weft_load_piece piece;
    weft_load *load;
    struct piece *next;
} piece;

/* Everything but `steps` and `data` is guarded by the loader's mutex. */
struct weft_load {
    weft_loader *loader;
    weft_load_steps steps;
    void *data;
    int slot;
    bool cancelled, read;
    weft_code code; /* of reading, once that is done; of a piece that failed */
    weft_error error;
    double share;
    weft_load *next;
};

struct weft_loader {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t started, taken, handed; /* a load; a piece taken; a piece handed over, or a load read */
    bool stops;
    weft_load *first; /* those not released yet; the first that is not read is the one that runs */
    piece *first_piece, **end_of_pieces;
    size_t bytes_waiting;
    long reported; /* percent of the load that the caller who waits was told of */
};

/* ---- The background ---- */

static weft_load *next_to_read(const weft_loader *loader)
{
    weft_load *load = loader->first;
    while (load && load->read)
        load = load->next;
    return load;
}

static void *run(void *context)
{
    weft_loader *loader = context;
    pthread_mutex_lock(&loader->mutex);
    while (!loader->stops) {
        weft_load *load = next_to_read(loader);
        if (!load) {
            pthread_cond_wait(&loader->started, &loader->mutex);
            continue;
        }
        weft_error error = {0};
        bool cancelled = load->cancelled;
        pthread_mutex_unlock(&loader->mutex);
        weft_code code = cancelled ? WEFT_OK : load->steps.read(load->data, load, &error);
        pthread_mutex_lock(&loader->mutex);
        if (code != WEFT_OK && load->code == WEFT_OK) {
            load->code = code;
            load->error = error;
        }
        load->read = true;
        pthread_cond_broadcast(&loader->handed);
    }
    pthread_mutex_unlock(&loader->mutex);
    return NULL;
}

static bool is_given_up(const weft_load *load)
{
    return load->cancelled || load->code != WEFT_OK || load->loader->stops;
}

weft_code weft_load_post(weft_load *load, weft_load_piece handed, weft_error *error)
{
    weft_loader *loader = load->loader;
    piece *added = malloc(sizeof *added);
    if (!added) {
        handed.release(handed.data);
        return weft_fail_memory(error, "load", sizeof *added);
    }
    pthread_mutex_lock(&loader->mutex);
    while (!is_given_up(load) && loader->bytes_waiting > most_bytes_waiting)
        pthread_cond_wait(&loader->taken, &loader->mutex);
    bool given_up = is_given_up(load);
    if (!given_up) {
        *added = (piece){handed, load, NULL};
        *loader->end_of_pieces = added;
        loader->end_of_pieces = &added->next;
        loader->bytes_waiting += handed.bytes;
        pthread_cond_broadcast(&loader->handed);
    }
    pthread_mutex_unlock(&loader->mutex);
    if (!given_up)
        return WEFT_OK;
    free(added);
    handed.release(handed.data);
    return weft_fail(error, WEFT_SYSTEM, "loading was cancelled");
}

bool weft_load_rest(weft_load *load, double rest_s)
{
    weft_loader *loader = load->loader;
    struct timespec end;
    int status = 0;
    clock_gettime(CLOCK_REALTIME, &end);
    long nanoseconds = end.tv_nsec + lrint(1e9 * rest_s);
    end.tv_sec += nanoseconds / 1000000000;
    end.tv_nsec = nanoseconds % 1000000000;
    pthread_mutex_lock(&loader->mutex);
    while (!is_given_up(load) && status == 0)
        status = pthread_cond_timedwait(&loader->taken, &loader->mutex, &end);
    bool goes_on = !is_given_up(load);
    pthread_mutex_unlock(&loader->mutex);
    return goes_on;
}

static void report(void *context, const char *stage, long done, long total)
{
    (void)stage;
    weft_load *load = context;
    pthread_mutex_lock(&load->loader->mutex);
    load->share = total > 0 ? (double)done / (double)total : 0;
    pthread_mutex_unlock(&load->loader->mutex);
}

weft_progress weft_load_progress(weft_load *load)
{
    return (weft_progress){report, load};
}

/* ---- The drawing thread ---- */

weft_code weft_loader_create(weft_loader **result, weft_error *error)
{
    *result = NULL;
    weft_loader *loader = calloc(1, sizeof *loader);
    if (!loader)
        return weft_fail_memory(error, "loader", sizeof *loader);
    loader->end_of_pieces = &loader->first_piece;
    pthread_mutex_init(&loader->mutex, NULL);
    pthread_cond_init(&loader->started, NULL);
    pthread_cond_init(&loader->taken, NULL);
    pthread_cond_init(&loader->handed, NULL);
    if (pthread_create(&loader->thread, NULL, run, loader) != 0) {
        free(loader);
        return weft_fail(error, WEFT_SYSTEM, "cannot start a thread to load in");
    }
    *result = loader;
    return WEFT_OK;
}

static piece *take_piece(weft_loader *loader)
{
    piece *taken = loader->first_piece;
    if (!taken)
        return NULL;
    loader->first_piece = taken->next;
    if (!taken->next)
        loader->end_of_pieces = &loader->first_piece;
    loader->bytes_waiting -= taken->piece.bytes;
    pthread_cond_broadcast(&loader->taken);
    return taken;
}

void weft_loader_free(weft_loader *loader)
{
    if (!loader)
        return;
    pthread_mutex_lock(&loader->mutex);
    loader->stops = true;
    pthread_cond_broadcast(&loader->started);
    pthread_cond_broadcast(&loader->taken);
    pthread_mutex_unlock(&loader->mutex);
    pthread_join(loader->thread, NULL);
    for (piece *left = take_piece(loader); left; left = take_piece(loader)) {
        left->piece.release(left->piece.data);
        free(left);
    }
    for (weft_load *load = loader->first, *next; load; load = next) {
        next = load->next;
        load->steps.release(load->data);
        free(load);
    }
    pthread_cond_destroy(&loader->started);
    pthread_cond_destroy(&loader->taken);
    pthread_cond_destroy(&loader->handed);
    pthread_mutex_destroy(&loader->mutex);
    free(loader);
}

/* Holding the mutex. */
static weft_load **cancel(weft_loader *loader, int slot)
{
    weft_load **end = &loader->first;
    for (; *end; end = &(*end)->next)
        (*end)->cancelled |= (*end)->slot == slot;
    pthread_cond_broadcast(&loader->taken);
    return end;
}

void weft_loader_cancel(weft_loader *loader, int slot)
{
    pthread_mutex_lock(&loader->mutex);
    cancel(loader, slot);
    pthread_mutex_unlock(&loader->mutex);
}

weft_code weft_loader_start(weft_loader *loader, int slot, const weft_load_steps *steps, void *data, weft_error *error)
{
    weft_load *load = calloc(1, sizeof *load);
    if (!load) {
        steps->release(data);
        return weft_fail_memory(error, "load", sizeof *load);
    }
    *load = (weft_load){.loader = loader, .steps = *steps, .data = data, .slot = slot};
    pthread_mutex_lock(&loader->mutex);
    *cancel(loader, slot) = load;
    pthread_cond_broadcast(&loader->started);
    pthread_mutex_unlock(&loader->mutex);
    return WEFT_OK;
}

static void run_piece(weft_loader *loader, piece *taken)
{
    weft_load *load = taken->load;
    weft_error error = {0};
    pthread_mutex_lock(&loader->mutex);
    bool given_up = is_given_up(load);
    pthread_mutex_unlock(&loader->mutex);
    weft_code code = given_up ? WEFT_OK : taken->piece.run(taken->piece.data, &error);
    taken->piece.release(taken->piece.data);
    free(taken);
    if (code == WEFT_OK)
        return;
    pthread_mutex_lock(&loader->mutex);
    load->code = code;
    load->error = error;
    pthread_cond_broadcast(&loader->taken);
    pthread_mutex_unlock(&loader->mutex);
}

/* A load that is read and has no pieces left (they lie in the order of the loads); out of the list. */
static weft_load *take_finished(weft_loader *loader)
{
    weft_load *load = loader->first;
    if (!load || !load->read || (loader->first_piece && loader->first_piece->load == load))
        return NULL;
    loader->first = load->next;
    return load;
}

static weft_code finish(weft_load *load, bool *shown, weft_error *error)
{
    weft_code code = load->cancelled ? WEFT_OK : load->code;
    if (code != WEFT_OK)
        weft_error_set(error, code, "%s", load->error.message);
    else if (!load->cancelled)
        code = load->steps.show(load->data, error);
    *shown |= !load->cancelled && code == WEFT_OK;
    load->steps.release(load->data);
    free(load);
    return code;
}

weft_code weft_loader_poll(weft_loader *loader, double budget_s, bool *shown, weft_error *error)
{
    double end_s = weft_now_s() + budget_s;
    *shown = false;
    do {
        pthread_mutex_lock(&loader->mutex);
        weft_load *finished = take_finished(loader);
        piece *taken = finished ? NULL : take_piece(loader);
        pthread_mutex_unlock(&loader->mutex);
        if (finished)
            WEFT_TRY(finish(finished, shown, error));
        else if (taken)
            run_piece(loader, taken);
        else
            break;
    } while (weft_now_s() < end_s);
    return WEFT_OK;
}

/* False where nothing will come. */
static bool wait_for_work(weft_loader *loader)
{
    pthread_mutex_lock(&loader->mutex);
    while (loader->first && !loader->first->read && !loader->first_piece)
        pthread_cond_wait(&loader->handed, &loader->mutex);
    bool some = loader->first != NULL;
    pthread_mutex_unlock(&loader->mutex);
    return some;
}

weft_code weft_loader_wait(weft_loader *loader, const weft_progress *progress, bool *some, weft_error *error)
{
    const long steps = 100;
    bool shown = false;
    *some = wait_for_work(loader);
    long done = lrint(weft_loader_progress(loader) * steps);
    if (done > 0 && done != loader->reported)
        weft_progress_report(progress, "loading samples", done, steps);
    loader->reported = done;
    return *some ? weft_loader_poll(loader, 0, &shown, error) : WEFT_OK;
}

double weft_loader_progress(weft_loader *loader)
{
    pthread_mutex_lock(&loader->mutex);
    double share = loader->first ? loader->first->share : -1;
    pthread_mutex_unlock(&loader->mutex);
    return share;
}
