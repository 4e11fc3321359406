#include "compare/tradeoff/held_pictures.h"

#include "compare/pictures/sample_picture.h"
#include "evaluate/error/image_pair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of pictures that are equal, in a mean. */
static const double largest_psnr_db = 99;

/* The golden section: its multiples fill a step evenly, so that no light is met again and again where images come view
 * after view. */
static const double section = 0.6180339887498949;

/* Which of the candidates is the `count`-th of those that are wanted. */
static long candidate_of(int count, int wanted, int candidates)
{
    return (long)((count + fmod(section * count, 1)) * candidates / wanted);
}

int weft_held_pictures_choose(const weft_trial *trial, int image[WEFT_HELD_PICTURES])
{
    int most = 0, candidates = 0, count = 0;
    for (int i = 0; i < trial->held_count; i++)
        most = trial->flags[i] > most ? trial->flags[i] : most;
    for (int i = 0; i < trial->held_count; i++)
        candidates += trial->flags[i] == most;
    int wanted = candidates < WEFT_HELD_PICTURES ? candidates : WEFT_HELD_PICTURES;
    for (int i = 0, seen = 0; i < trial->held_count; i++) {
        if (trial->flags[i] != most)
            continue;
        if (count < wanted && seen++ >= candidate_of(count, wanted, candidates)) /* two may fall on the same */
            image[count++] = trial->image[i];
    }
    return count;
}

void weft_held_pictures_keep(weft_trial *trial)
{
    int image[WEFT_HELD_PICTURES], count = weft_held_pictures_choose(trial, image), kept = 0;
    for (int i = 0; i < trial->held_count && kept < count; i++) {
        if (trial->image[i] != image[kept])
            continue;
        trial->flags[kept] = trial->flags[i];
        trial->image[kept++] = trial->image[i];
    }
    trial->held_count = kept;
    trial->fitted_count = 0;
}

/* Red, green and blue of a sample follow each other. */
static void fill(const weft_trial *trial, const weft_asked_samples *said, weft_image_pair *pair)
{
    const weft_texel_block *block = &trial->asked;
    size_t images = (size_t)trial->excerpt->layout.image_count, width = (size_t)trial->excerpt->layout.width;
    memset(pair->mask, 1, (size_t)pair->sample.width * (size_t)pair->sample.height);
    for (size_t i = 0; i < said->count; i++) {
        size_t of_excerpt = said->sample[i] / images;
        size_t texel =
            (of_excerpt / width - (size_t)block->y) * (size_t)block->width + of_excerpt % width - (size_t)block->x;
        if (said->sample[i] % images != (size_t)pair->image)
            continue;
        pair->mask[texel] = 0;
        pair->sample.pixels[3 * texel + i % 3] = said->value[i].sample;
        pair->prediction.pixels[3 * texel + i % 3] = said->value[i].prediction;
    }
}

/* The kinds of the pixels; none of those that are masked. The caller frees the result; NULL where memory is short. */
static uint8_t *kinds_of_pixels(const weft_trial *trial, const uint8_t *kinds, const weft_image_pair *pair)
{
    const weft_dataset_layout *layout = &trial->excerpt->layout;
    const weft_texel_block *block = &trial->asked;
    int count = block->width * block->height;
    uint8_t *result = malloc((size_t)count);
    for (int i = 0; result && i < count; i++) {
        int x = block->x + i % block->width, y = block->y + i / block->width;
        size_t texel = (size_t)y * (size_t)layout->width + (size_t)x;
        uint8_t kind = kinds[texel * (size_t)layout->image_count + (size_t)pair->image];
        result[i] = pair->mask[i] ? 0 : kind;
    }
    return result;
}

/* Into the mean over pixels. */
static void take_quality(const weft_picture_quality *one, long pixels, weft_picture_quality *mean, long *taken)
{
    *taken += pixels;
    if (pixels == 0)
        return;
    double share = (double)pixels / (double)*taken;
    mean->psnr_db += share * (fmin(one->psnr_db, largest_psnr_db) - mean->psnr_db);
    mean->ssim += share * (one->ssim - mean->ssim);
    mean->flip += share * (one->flip - mean->flip);
}

static weft_code measure_quality(const weft_image *sample, const weft_image *predicted, const uint8_t *kinds,
                                 weft_held_error *measured, weft_error *error)
{
    weft_picture_quality quality[WEFT_SAMPLE_KINDS];
    long pixels[WEFT_SAMPLE_KINDS];
    WEFT_TRY(weft_picture_quality_by_region(sample, predicted, kinds, WEFT_SAMPLE_KINDS, quality, pixels, error));
    for (int kind = 0; kind < WEFT_SAMPLE_KINDS; kind++)
        take_quality(&quality[kind], pixels[kind], &measured->quality[kind], &measured->picture_pixels[kind]);
    measured->picture_count++;
    return WEFT_OK;
}

/* The pictures become those of `measured` where they are to be kept. */
static weft_code compare_shown(const weft_image_pair *pair, const uint8_t *kinds, double exposure, bool keep,
                               weft_held_error *measured, weft_error *error)
{
    weft_image sample = {0}, predicted = {0};
    weft_code code = weft_picture_encode(&pair->sample, NULL, exposure, &sample, error);
    if (code == WEFT_OK)
        code = weft_picture_encode(&pair->prediction, NULL, exposure, &predicted, error);
    if (code == WEFT_OK)
        code = measure_quality(&sample, &predicted, kinds, measured, error);
    if (code == WEFT_OK && keep) {
        weft_image_free(&measured->sample);
        weft_image_free(&measured->predicted);
        measured->worst_image = pair->image;
        measured->sample = sample;
        measured->predicted = predicted;
        return WEFT_OK;
    }
    weft_image_free(&sample);
    weft_image_free(&predicted);
    return code;
}

static weft_code compare_image(const weft_trial *trial, const weft_asked_samples *said, const uint8_t *kinds, int image,
                               double *worst, weft_held_error *measured, weft_error *error)
{
    uint8_t *kinds_shown = NULL;
    weft_image_pair pair;
    weft_error_summary summary;
    double exposure;
    weft_dataset_layout shown = trial->excerpt->layout;
    shown.width = trial->asked.width;
    shown.height = trial->asked.height;
    weft_code code = weft_image_pair_create(&shown, image, &pair, error);
    if (code == WEFT_OK) {
        fill(trial, said, &pair);
        code = weft_image_pair_error(&pair, &summary, error);
    }
    if (code == WEFT_OK) {
        kinds_shown = kinds_of_pixels(trial, kinds, &pair);
        code = kinds_shown ? WEFT_OK : weft_fail_memory(error, "pictures", (size_t)shown.width * (size_t)shown.height);
    }
    if (code == WEFT_OK)
        code = weft_picture_exposure(&pair.sample, pair.mask, &exposure, error);
    if (code == WEFT_OK && summary.count > 0) {
        bool is_worst = summary.relative_rmse > *worst;
        *worst = is_worst ? summary.relative_rmse : *worst;
        code = compare_shown(&pair, kinds_shown, exposure, is_worst, measured, error);
    }
    weft_image_pair_free(&pair);
    free(kinds_shown);
    return code;
}

weft_code weft_held_pictures_compare(const weft_trial *trial, const weft_asked_samples *said, const uint8_t *kinds,
                                     weft_held_error *measured, weft_error *error)
{
    int image[WEFT_HELD_PICTURES], count = weft_held_pictures_choose(trial, image);
    double worst = -1;
    for (int i = 0; i < count; i++)
        WEFT_TRY(compare_image(trial, said, kinds, image[i], &worst, measured, error));
    return WEFT_OK;
}
