#include "study/verify.h"

#include <stdlib.h>

/* What the mask says, in samples of a texel in an image. */
typedef struct mask_counts {
    long valid, missing, saturated, shadowed;
} mask_counts;

static void count_masks(const uint8_t *mask, size_t count, mask_counts *counts)
{
    for (size_t i = 0; i < count; i++) {
        counts->valid += mask[i] == 0;
        counts->missing += (mask[i] & WEFT_MASK_MISSING) != 0;
        counts->saturated += (mask[i] & WEFT_MASK_SATURATED) != 0;
        counts->shadowed += (mask[i] & WEFT_MASK_SHADOWED) != 0;
    }
}

static weft_code check_opacity(weft_dataset *dataset, int y, float *opacity, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    WEFT_TRY(weft_dataset_read_opacity(dataset, y, 1, opacity, error));
    size_t views = (size_t)layout->view_count, count = (size_t)layout->width * views;
    for (size_t i = 0; i < count; i++) {
        if (!(opacity[i] >= 0 && opacity[i] <= 1))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': opacity %g at texel (%zu, %d), view %zu",
                             weft_dataset_path(dataset), (double)opacity[i], i / views, y, i % views);
    }
    return WEFT_OK;
}

/* Samples are checked by the reader; a row of texels is small enough to hold and large enough to stream well. */
static weft_code read_rows(weft_dataset *dataset, weft_half *samples, uint8_t *mask, float *opacity,
                           const weft_progress *progress, mask_counts *counts, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t row = (size_t)layout->width * (size_t)layout->image_count;
    for (int y = 0; y < layout->height; y++) {
        WEFT_TRY(weft_dataset_read_block(dataset, 0, y, layout->width, 1, samples, mask, error));
        WEFT_TRY(check_opacity(dataset, y, opacity, error));
        count_masks(mask, row, counts);
        weft_progress_report(progress, "checking samples", y + 1, layout->height);
    }
    return WEFT_OK;
}

weft_code weft_verify_dataset(weft_dataset *dataset, const weft_progress *progress, json_t *description,
                              weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t row = (size_t)layout->width * (size_t)layout->image_count;
    weft_half *samples = malloc(3 * row * sizeof *samples);
    uint8_t *mask = malloc(row);
    float *opacity = malloc((size_t)layout->width * (size_t)layout->view_count * sizeof *opacity);
    mask_counts counts = {0};
    weft_code code = WEFT_OK;
    if (!samples || !mask || !opacity)
        code = weft_fail_memory(error, "row of texels", 7 * row);
    else
        code = read_rows(dataset, samples, mask, opacity, progress, &counts, error);
    free(samples);
    free(mask);
    free(opacity);
    json_t *verified = json_pack("{s:I, s:I, s:I, s:I}", "valid_samples", (json_int_t)counts.valid, "missing",
                                 (json_int_t)counts.missing, "saturated", (json_int_t)counts.saturated, "shadowed",
                                 (json_int_t)counts.shadowed);
    json_object_set_new(description, "verified", verified);
    return code;
}
