#include "compress/run/block_reader.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { SLOTS = 2 };

struct weft_block_reader {
    weft_dataset *dataset;
    const weft_block_place *place;
    size_t count;
    weft_block_samples slot[SLOTS]; /* block i lies in slot i % SLOTS */
    pthread_t thread;
    bool is_running;
    /* Below: under the mutex. */
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    size_t filled, taken, released; /* blocks read, given to the caller, given back */
    bool stop;
    weft_code code;
    weft_error error;
};

uint64_t weft_block_reader_bytes(const weft_dataset_layout *layout, size_t texels)
{
    return SLOTS * texels * (uint64_t)layout->image_count * (3 * sizeof(weft_half) + sizeof(uint8_t));
}

/* ---- The reading thread ---- */

static bool wait_for_a_free_slot(weft_block_reader *reader)
{
    pthread_mutex_lock(&reader->mutex);
    while (!reader->stop && reader->filled - reader->released == SLOTS)
        pthread_cond_wait(&reader->changed, &reader->mutex);
    bool go_on = !reader->stop;
    pthread_mutex_unlock(&reader->mutex);
    return go_on;
}

static bool read_into(weft_block_reader *reader, size_t index)
{
    weft_block_samples *block = &reader->slot[index % SLOTS];
    block->place = reader->place[index];
    const weft_block_place *place = &block->place;
    weft_error error = {0};
    weft_code code = weft_dataset_read_block(reader->dataset, place->x, place->y, place->width, place->height,
                                             block->samples, block->mask, &error);
    pthread_mutex_lock(&reader->mutex);
    reader->code = code;
    reader->error = error;
    reader->filled += code == WEFT_OK;
    pthread_cond_broadcast(&reader->changed);
    pthread_mutex_unlock(&reader->mutex);
    return code == WEFT_OK;
}

static void *read_all(void *context)
{
    weft_block_reader *reader = context;
    for (size_t i = 0; i < reader->count && wait_for_a_free_slot(reader) && read_into(reader, i); i++)
        continue;
    return NULL;
}

/* ---- The caller's side ---- */

weft_code weft_block_reader_create(weft_dataset *dataset, const weft_block_place *place, size_t count, size_t texels,
                                   weft_block_reader **result, weft_error *error)
{
    *result = NULL;
    size_t images = (size_t)weft_dataset_get_layout(dataset)->image_count;
    weft_block_reader *reader = calloc(1, sizeof *reader);
    if (!reader)
        return weft_fail_memory(error, "block reader", sizeof *reader);
    reader->dataset = dataset;
    reader->place = place;
    reader->count = count;
    pthread_mutex_init(&reader->mutex, NULL);
    pthread_cond_init(&reader->changed, NULL);
    weft_code code = WEFT_OK;
    for (int i = 0; i < SLOTS; i++) {
        reader->slot[i].samples = malloc(3 * texels * images * sizeof(weft_half));
        reader->slot[i].mask = malloc(texels * images);
        if (!reader->slot[i].samples || !reader->slot[i].mask)
            code = weft_fail_memory(error, "block of the dataset", 7 * texels * images);
    }
    if (code == WEFT_OK) {
        int failure = pthread_create(&reader->thread, NULL, read_all, reader);
        reader->is_running = failure == 0;
        if (failure != 0)
            code = weft_fail(error, WEFT_SYSTEM, "cannot start a thread that reads: %s", strerror(failure));
    }
    if (code == WEFT_OK)
        *result = reader;
    else
        weft_block_reader_free(reader);
    return code;
}

weft_code weft_block_reader_next(weft_block_reader *reader, const weft_block_samples **block, weft_error *error)
{
    if (reader->taken == reader->count)
        return weft_fail(error, WEFT_BAD_USAGE, "all %zu blocks have been read", reader->count);
    pthread_mutex_lock(&reader->mutex);
    reader->released = reader->taken;
    pthread_cond_broadcast(&reader->changed);
    while (reader->code == WEFT_OK && reader->filled == reader->taken)
        pthread_cond_wait(&reader->changed, &reader->mutex);
    weft_code code = reader->filled > reader->taken ? WEFT_OK : reader->code;
    if (code == WEFT_OK)
        *block = &reader->slot[reader->taken++ % SLOTS];
    else if (error)
        *error = reader->error;
    pthread_mutex_unlock(&reader->mutex);
    return code;
}

void weft_block_reader_free(weft_block_reader *reader)
{
    if (!reader)
        return;
    pthread_mutex_lock(&reader->mutex);
    reader->stop = true;
    pthread_cond_broadcast(&reader->changed);
    pthread_mutex_unlock(&reader->mutex);
    if (reader->is_running)
        pthread_join(reader->thread, NULL);
    for (int i = 0; i < SLOTS; i++) {
        free(reader->slot[i].samples);
        free(reader->slot[i].mask);
    }
    pthread_cond_destroy(&reader->changed);
    pthread_mutex_destroy(&reader->mutex);
    free(reader);
}
