#include "btf/dataset/write_blocks.h"

#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "btf/dataset/create.h"

#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const size_t block_bytes = (size_t)1 << 26;

/* Directions, provenance and the index of the chunks, generously. */
static const size_t other_bytes = (size_t)1 << 20;

struct weft_dataset_block_writer {
    char *path;
    const weft_dataset_layout *layout;
    weft_atomic_file atomic;
    weft_dataset_file file;
    bool is_open; /* whether `file` is */
};

void weft_dataset_block_size(const weft_dataset_layout *layout, int *width, int *height)
{
    int chunk;
    weft_dataset_chunk(layout, &chunk, height);
    size_t bytes = (size_t)chunk * (size_t)*height * (size_t)layout->image_count * 3 * sizeof(weft_half);
    size_t most = block_bytes / bytes * (size_t)chunk;
    *width = most < (size_t)chunk ? chunk : most > (size_t)layout->width ? layout->width : (int)most;
}

/* Takes and gives back the disk space of the whole file: HDF5 1.10 crashes at exit where it could not write one. */
static weft_code check_space(const weft_dataset_block_writer *writer, weft_error *error)
{
    const weft_dataset_layout *layout = writer->layout;
    size_t samples = (size_t)layout->width * (size_t)layout->height * (size_t)layout->image_count;
    size_t bytes = samples * (3 * sizeof(weft_half) + sizeof(uint8_t)) + other_bytes;
    int descriptor = open(writer->atomic.temporary_path, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return weft_fail_errno(error, "write", writer->path);
    int failure = posix_fallocate(descriptor, 0, (off_t)bytes);
    close(descriptor);
    if (failure != 0)
        return weft_fail(error, WEFT_SYSTEM, "cannot reserve %zu bytes for '%s': %s", bytes, writer->path,
                         strerror(failure));
    return WEFT_OK;
}

static weft_code prepare(weft_dataset_block_writer *writer, weft_error *error)
{
    const weft_dataset_layout *layout = writer->layout;
    WEFT_TRY(weft_dataset_layout_check(layout, writer->path, WEFT_BAD_INPUT, error));
    WEFT_TRY(weft_atomic_file_begin(writer->path, &writer->atomic, error));
    WEFT_TRY(check_space(writer, error));
    WEFT_TRY(weft_dataset_create(writer->atomic.temporary_path, writer->path, layout, error));
    WEFT_TRY(weft_dataset_file_open(writer->atomic.temporary_path, writer->path, &writer->file, error));
    writer->is_open = true;
    return WEFT_OK;
}

weft_code weft_dataset_block_writer_create(const char *path, const weft_dataset_layout *layout,
                                           weft_dataset_block_writer **result, weft_error *error)
{
    *result = NULL;
    weft_dataset_block_writer *writer = calloc(1, sizeof *writer);
    if (!writer)
        return weft_fail_memory(error, "dataset writer", sizeof *writer);
    writer->layout = layout;
    writer->path = strdup(path);
    weft_code code = writer->path ? prepare(writer, error) : weft_fail_memory(error, "path", strlen(path));
    if (code == WEFT_OK)
        *result = writer;
    else
        weft_dataset_block_writer_abandon(writer);
    return code;
}

weft_code weft_dataset_block_writer_put(weft_dataset_block_writer *writer, int x, int y, int width, int height,
                                        const weft_half *samples, const uint8_t *mask, weft_error *error)
{
    return weft_dataset_file_write(&writer->file, writer->layout, x, y, width, height, samples, mask, error);
}

weft_code weft_dataset_block_writer_put_opacity(weft_dataset_block_writer *writer, const float *opacity,
                                                weft_error *error)
{
    return weft_dataset_file_write_opacity(&writer->file, writer->layout, opacity, error);
}

weft_code weft_dataset_block_writer_put_frames(weft_dataset_block_writer *writer, const float *frames,
                                               weft_error *error)
{
    return weft_dataset_file_write_frames(&writer->file, writer->layout, frames, error);
}

weft_code weft_dataset_block_writer_put_heights(weft_dataset_block_writer *writer, const weft_dataset_heights *heights,
                                                weft_error *error)
{
    WEFT_TRY(weft_dataset_heights_check(writer->layout, heights, writer->path, WEFT_BAD_INPUT, error));
    return weft_dataset_file_write_relief(&writer->file, writer->layout->plane_mm, heights, error);
}

static weft_code finish(weft_dataset_block_writer *writer, const char *provenance, weft_error *error)
{
    WEFT_TRY(weft_dataset_provenance_check(provenance, writer->path, WEFT_BAD_USAGE, error));
    WEFT_TRY(weft_dataset_file_write_figures(&writer->file, writer->layout, error));
    WEFT_TRY(weft_dataset_file_write_provenance(&writer->file, provenance, error));
    writer->is_open = false;
    WEFT_TRY(weft_dataset_file_close(&writer->file, error));
    return weft_atomic_file_commit(&writer->atomic, error);
}

weft_code weft_dataset_block_writer_finish(weft_dataset_block_writer *writer, const char *provenance, weft_error *error)
{
    weft_code code = finish(writer, provenance, error);
    weft_dataset_block_writer_abandon(writer);
    return code;
}

void weft_dataset_block_writer_abandon(weft_dataset_block_writer *writer)
{
    if (!writer)
        return;
    if (writer->is_open)
        weft_dataset_file_close(&writer->file, NULL);
    weft_atomic_file_abandon(&writer->atomic);
    free(writer->path);
    free(writer);
}

/* ---- Of a dataset that is computed from another one ---- */

weft_code weft_derived_dataset_check(const weft_dataset *dataset, const char *output, const char *loss,
                                     weft_error *error)
{
    if (weft_is_same_file(weft_dataset_path(dataset), output))
        return weft_fail(error, WEFT_BAD_USAGE, "'%s' is the dataset itself; %s", output, loss);
    return WEFT_OK;
}

weft_code weft_derived_dataset_finish(weft_dataset_block_writer *writer, const weft_dataset_layout *source,
                                      const char *name, json_t *made, weft_error *error)
{
    char *text = weft_json_with_member(source->provenance, name, made, JSON_COMPACT);
    if (!text) {
        weft_dataset_block_writer_abandon(writer);
        return weft_fail_memory(error, "provenance", 0);
    }
    weft_code code = weft_dataset_block_writer_finish(writer, text, error);
    free(text);
    return code;
}
