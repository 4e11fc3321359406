#include "inspect/verify.h"

#include "btf/dataset/dataset.h"

#include <stdlib.h>

/* What the mask says, in samples of a texel in an image. */
typedef struct mask_counts {
    long valid, missing, saturated, other;
} mask_counts;

static void count_masks(const uint8_t *mask, size_t count, mask_counts *counts)
{
    for (size_t i = 0; i < count; i++) {
        counts->valid += mask[i] == 0;
        counts->missing += (mask[i] & WEFT_MASK_MISSING) != 0;
        counts->saturated += (mask[i] & WEFT_MASK_SATURATED) != 0;
        counts->other += (mask[i] & ~(WEFT_MASK_MISSING | WEFT_MASK_SATURATED)) != 0;
    }
}

/* Room for one band of texels. */
typedef struct band {
    int height;
    weft_half *samples;
    uint8_t *mask;
    float *opacity, *frames;
} band;

/* What is read is checked by the reader. */
static weft_code read_bands(weft_dataset *dataset, const band *b, const weft_progress *progress, mask_counts *counts,
                            weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    for (int y = 0; y < layout->height; y += b->height) {
        int height = b->height < layout->height - y ? b->height : layout->height - y;
        WEFT_TRY(weft_dataset_read_block(dataset, 0, y, layout->width, height, b->samples, b->mask, error));
        WEFT_TRY(weft_dataset_read_opacity(dataset, y, height, b->opacity, error));
        WEFT_TRY(weft_dataset_read_frames(dataset, y, height, b->frames, error));
        count_masks(b->mask, (size_t)height * (size_t)layout->width * (size_t)layout->image_count, counts);
        weft_progress_report(progress, "checking samples", y + height, layout->height);
    }
    return WEFT_OK;
}

weft_code weft_verify_dataset(weft_dataset *dataset, const weft_progress *progress, json_t *description,
                              weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    band b = {.height = weft_dataset_rows_at_once(layout)};
    size_t texels = (size_t)b.height * (size_t)layout->width, images = (size_t)layout->image_count;
    b.samples = malloc(3 * texels * images * sizeof *b.samples);
    b.mask = malloc(texels * images);
    b.opacity = malloc(texels * (size_t)layout->view_count * sizeof *b.opacity);
    b.frames = malloc(6 * texels * sizeof *b.frames);
    mask_counts counts = {0};
    weft_code code = WEFT_OK;
    if (!b.samples || !b.mask || !b.opacity || !b.frames)
        code = weft_fail_memory(error, "rows of texels", 7 * texels * images);
    else
        code = read_bands(dataset, &b, progress, &counts, error);
    free(b.samples);
    free(b.mask);
    free(b.opacity);
    free(b.frames);
    json_t *verified = json_pack("{s:I, s:I, s:I, s:I}", "valid_samples", (json_int_t)counts.valid, "missing",
                                 (json_int_t)counts.missing, "saturated", (json_int_t)counts.saturated,
                                 "masked_otherwise", (json_int_t)counts.other);
    if (json_object_set_new(description, "verified", verified) != 0 && code == WEFT_OK)
        code = weft_fail_memory(error, "description", 0);
    return code;
}
