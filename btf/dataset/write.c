#include "base/atomic_file.h"
#include "base/integers.h"
#include "btf/dataset/create.h"
#include "btf/dataset/scratch.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Memory of the transposition: what is gathered before it is written. */
static const size_t block_bytes = (size_t)1 << 27;

/* Images gathered together: their samples of one texel then fill whole cache lines. */
enum { IMAGE_GROUP = 32 };

struct weft_dataset_writer {
    char *path;
    weft_dataset_layout layout;
    weft_atomic_file file;
    weft_scratch scratch;
    float *opacity, *frames; /* NULL where none were put */
    weft_dataset_heights heights;
};

static weft_code copy_layout(weft_dataset_layout *copy, const weft_dataset_layout *layout, weft_error *error)
{
    *copy = *layout;
    WEFT_TRY(weft_dataset_layout_allocate(copy, error));
    size_t images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    memcpy(copy->light, layout->light, images * sizeof *copy->light);
    memcpy(copy->view, layout->view, views * sizeof *copy->view);
    memcpy(copy->view_of_image, layout->view_of_image, images * sizeof *copy->view_of_image);
    for (int i = 0; i < WEFT_IMAGE_FIGURES; i++) {
        if (!layout->figure[i])
            continue;
        WEFT_TRY(weft_dataset_layout_allocate_figure(copy, (weft_image_figure)i, error));
        memcpy(copy->figure[i], layout->figure[i], images * sizeof *copy->figure[i]);
    }
    if (!layout->provenance)
        return WEFT_OK;
    free(copy->provenance);
    copy->provenance = strdup(layout->provenance);
    return copy->provenance ? WEFT_OK : weft_fail_memory(error, "provenance", strlen(layout->provenance));
}

static weft_code prepare(weft_dataset_writer *writer, const weft_dataset_layout *layout, weft_error *error)
{
    WEFT_TRY(weft_dataset_layout_check_counts(layout, writer->path, WEFT_BAD_INPUT, error));
    WEFT_TRY(copy_layout(&writer->layout, layout, error));
    WEFT_TRY(weft_dataset_layout_check(&writer->layout, writer->path, WEFT_BAD_INPUT, error));
    WEFT_TRY(weft_atomic_file_begin(writer->path, &writer->file, error));
    WEFT_TRY(
        weft_scratch_create(writer->path, layout->width, layout->height, layout->image_count, &writer->scratch, error));
    return weft_dataset_create(writer->file.temporary_path, writer->path, layout, error);
}

weft_code weft_dataset_writer_create(const char *path, const weft_dataset_layout *layout, weft_dataset_writer **result,
                                     weft_error *error)
{
    *result = NULL;
    weft_dataset_writer *writer = calloc(1, sizeof *writer);
    if (!writer)
        return weft_fail_memory(error, "dataset writer", sizeof *writer);
    writer->scratch.descriptor = -1;
    writer->path = strdup(path);
    weft_code code = writer->path ? prepare(writer, layout, error) : weft_fail_memory(error, "path", strlen(path));
    if (code == WEFT_OK)
        *result = writer;
    else
        weft_dataset_writer_abandon(writer);
    return code;
}

weft_code weft_dataset_writer_put_image(weft_dataset_writer *writer, int image, const weft_half *samples,
                                        const uint8_t *mask, weft_error *error)
{
    if (image < 0 || image >= writer->layout.image_count)
        return weft_fail(error, WEFT_BAD_USAGE, "'%s': image %d of %d", writer->path, image,
                         writer->layout.image_count);
    return weft_scratch_put(&writer->scratch, image, samples, mask, error);
}

/* Keeps a copy in the place of the one before. */
static weft_code keep_floats(float **kept, const float *values, size_t count, const char *what, weft_error *error)
{
    free(*kept);
    *kept = malloc(count * sizeof *values);
    if (!*kept)
        return weft_fail_memory(error, what, count * sizeof *values);
    memcpy(*kept, values, count * sizeof *values);
    return WEFT_OK;
}

weft_code weft_dataset_writer_put_opacity(weft_dataset_writer *writer, const float *opacity, weft_error *error)
{
    const weft_dataset_layout *layout = &writer->layout;
    size_t views = (size_t)layout->view_count, count = (size_t)layout->width * (size_t)layout->height * views;
    for (size_t i = 0; i < count; i++) {
        if (!(opacity[i] >= 0 && opacity[i] <= 1))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': opacity %g of view %zu is not in 0 to 1", writer->path,
                             opacity[i], i % views);
    }
    return keep_floats(&writer->opacity, opacity, count, "opacity", error);
}

weft_code weft_dataset_writer_put_frames(weft_dataset_writer *writer, const float *frames, weft_error *error)
{
    const weft_dataset_layout *layout = &writer->layout;
    size_t count = (size_t)layout->width * (size_t)layout->height;
    WEFT_TRY(weft_dataset_frames_check(frames, count, 0, layout->width, writer->path, WEFT_BAD_INPUT, error));
    return keep_floats(&writer->frames, frames, 6 * count, "frames", error);
}

weft_code weft_dataset_writer_put_heights(weft_dataset_writer *writer, const weft_dataset_heights *heights,
                                          weft_error *error)
{
    float *value = writer->heights.value;
    WEFT_TRY(weft_dataset_heights_check(&writer->layout, heights, writer->path, WEFT_BAD_INPUT, error));
    weft_code code =
        keep_floats(&value, heights->value, (size_t)heights->width * (size_t)heights->height, "heights", error);
    writer->heights = *heights;
    writer->heights.value = value;
    return code;
}

weft_code weft_dataset_writer_put_figure(weft_dataset_writer *writer, weft_image_figure figure, const double *value,
                                         weft_error *error)
{
    weft_dataset_layout *layout = &writer->layout;
    if (!layout->figure[figure])
        WEFT_TRY(weft_dataset_layout_allocate_figure(layout, figure, error));
    memcpy(layout->figure[figure], value, (size_t)layout->image_count * sizeof *value);
    return weft_dataset_figure_check(layout, figure, writer->path, WEFT_BAD_INPUT, error);
}

/* ---- From images to texels ---- */

/* A block of texels with all its images, and what is read from the scratch file to fill it. */
typedef struct texel_block {
    int x, y, width, height;
    weft_half *samples;       /* [height][width][image_count][3] */
    uint8_t *mask;            /* [height][width][image_count] */
    weft_half *group_samples; /* [IMAGE_GROUP][height][width][3] */
    uint8_t *group_mask;      /* [IMAGE_GROUP][height][width] */
} texel_block;

/* Whole rows of chunks where they fit into block_bytes, else part of one row. */
static void choose_block(const weft_dataset_layout *layout, texel_block *block)
{
    int chunk_width, chunk_height;
    weft_dataset_chunk(layout, &chunk_width, &chunk_height);
    size_t texel_bytes = (size_t)layout->image_count * (3 * sizeof(weft_half) + 1);
    size_t chunks = block_bytes / ((size_t)chunk_width * (size_t)chunk_height * texel_bytes);
    size_t across = ((size_t)layout->width + (size_t)chunk_width - 1) / (size_t)chunk_width;
    size_t rows = chunks / across;
    bool is_part = rows == 0;
    block->width = is_part ? chunk_width * (int)(chunks > 0 ? chunks : 1) : layout->width;
    block->height = rows < (size_t)layout->height ? chunk_height * (int)(is_part ? 1 : rows) : layout->height;
    block->height = weft_smaller(block->height, layout->height);
}

static weft_code block_allocate(const weft_dataset_layout *layout, texel_block *block, weft_error *error)
{
    choose_block(layout, block);
    size_t texels = (size_t)block->width * (size_t)block->height, images = (size_t)layout->image_count;
    block->samples = malloc(texels * images * 3 * sizeof *block->samples);
    block->mask = malloc(texels * images);
    block->group_samples = malloc(texels * IMAGE_GROUP * 3 * sizeof *block->samples);
    block->group_mask = malloc(texels * IMAGE_GROUP);
    if (!block->samples || !block->mask || !block->group_samples || !block->group_mask)
        return weft_fail_memory(error, "block of texels", texels * (images + IMAGE_GROUP) * 7);
    return WEFT_OK;
}

static void block_free(texel_block *block)
{
    free(block->samples);
    free(block->mask);
    free(block->group_samples);
    free(block->group_mask);
}

static void scatter_group(const texel_block *block, size_t images, int first, int count)
{
    size_t texels = (size_t)block->width * (size_t)block->height;
    for (size_t texel = 0; texel < texels; texel++) {
        weft_half *samples = block->samples + 3 * (texel * images + (size_t)first);
        uint8_t *mask = block->mask + texel * images + (size_t)first;
        for (int i = 0; i < count; i++) {
            memcpy(samples + 3 * i, block->group_samples + 3 * ((size_t)i * texels + texel), 3 * sizeof *samples);
            mask[i] = block->group_mask[(size_t)i * texels + texel];
        }
    }
}

static weft_code gather(const weft_dataset_writer *writer, const texel_block *block, weft_error *error)
{
    int images = writer->layout.image_count;
    size_t texels = (size_t)block->width * (size_t)block->height;
    for (int first = 0; first < images; first += IMAGE_GROUP) {
        int count = weft_smaller(IMAGE_GROUP, images - first);
        for (int i = 0; i < count; i++)
            WEFT_TRY(weft_scratch_take(&writer->scratch, first + i, block->x, block->y, block->width, block->height,
                                       block->group_samples + 3 * (size_t)i * texels,
                                       block->group_mask + (size_t)i * texels, error));
        scatter_group(block, (size_t)images, first, count);
    }
    return WEFT_OK;
}

static weft_code transpose(const weft_dataset_writer *writer, const weft_dataset_file *file, texel_block whole,
                           weft_error *error)
{
    const weft_dataset_layout *layout = &writer->layout;
    for (int y = 0; y < layout->height; y += whole.height) {
        for (int x = 0; x < layout->width; x += whole.width) {
            texel_block block = whole;
            block.x = x;
            block.y = y;
            block.width = weft_smaller(whole.width, layout->width - x);
            block.height = weft_smaller(whole.height, layout->height - y);
            WEFT_TRY(gather(writer, &block, error));
            WEFT_TRY(weft_dataset_file_write(file, layout, x, y, block.width, block.height, block.samples, block.mask,
                                             error));
        }
    }
    return WEFT_OK;
}

static weft_code fill(const weft_dataset_writer *writer, const weft_dataset_file *file, const char *provenance,
                      weft_error *error)
{
    texel_block block = {0};
    weft_code code = block_allocate(&writer->layout, &block, error);
    if (code == WEFT_OK)
        code = transpose(writer, file, block, error);
    block_free(&block);
    WEFT_TRY(code);
    if (writer->opacity)
        WEFT_TRY(weft_dataset_file_write_opacity(file, &writer->layout, writer->opacity, error));
    if (writer->frames)
        WEFT_TRY(weft_dataset_file_write_frames(file, &writer->layout, writer->frames, error));
    if (writer->heights.value)
        WEFT_TRY(weft_dataset_file_write_relief(file, writer->layout.plane_mm, &writer->heights, error));
    WEFT_TRY(weft_dataset_file_write_figures(file, &writer->layout, error));
    return weft_dataset_file_write_provenance(file, provenance, error);
}

static weft_code finish(weft_dataset_writer *writer, const char *provenance, weft_error *error)
{
    if (!provenance)
        provenance = writer->layout.provenance;
    WEFT_TRY(weft_dataset_provenance_check(provenance, writer->path, WEFT_BAD_USAGE, error));
    weft_dataset_file file;
    WEFT_TRY(weft_dataset_file_open(writer->file.temporary_path, writer->path, &file, error));
    weft_code code = fill(writer, &file, provenance, error);
    weft_code closed = weft_dataset_file_close(&file, code == WEFT_OK ? error : NULL);
    WEFT_TRY(code);
    WEFT_TRY(closed);
    return weft_atomic_file_commit(&writer->file, error);
}

weft_code weft_dataset_writer_finish(weft_dataset_writer *writer, const char *provenance, weft_error *error)
{
    weft_code code = finish(writer, provenance, error);
    weft_dataset_writer_abandon(writer);
    return code;
}

void weft_dataset_writer_abandon(weft_dataset_writer *writer)
{
    if (!writer)
        return;
    weft_scratch_free(&writer->scratch);
    weft_atomic_file_abandon(&writer->file);
    weft_dataset_layout_free(&writer->layout);
    free(writer->opacity);
    free(writer->frames);
    weft_dataset_heights_free(&writer->heights);
    free(writer->path);
    free(writer);
}
