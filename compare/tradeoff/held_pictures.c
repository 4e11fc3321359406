#include "compare/tradeoff/held_error.h"

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
    size_t images = (size_t)trial->subset->layout.image_count, width = (size_t)trial->subset->layout.width;
    memset(pair->mask, 1, (size_t)pair->sample.width * (size_t)pair->sample.height);
    for (size_t i = 0; i < said->count; i++) {
        size_t of_subset = said->sample[i] / images;
        size_t texel =
            (of_subset / width - (size_t)block->y) * (size_t)block->width + of_subset % width - (size_t)block->x;
        if (said->sample[i] % images != (size_t)pair->image)
            continue;
        pair->mask[texel] = 0;
        pair->sample.pixels[3 * texel + i % 3] = said->value[i].sample;
        pair->prediction.pixels[3 * texel + i % 3] = said->value[i].prediction;
    }
}

/* Of the pixels that are not masked, into the mean over all pictures. */
static weft_code measure_quality(const weft_image *sample, const weft_image *predicted, const weft_image_pair *pair,
                                 weft_held_error *measured, weft_error *error)
{
    size_t count = (size_t)sample->width * (size_t)sample->height;
    weft_picture_quality one, *mean = &measured->quality;
    long pixels;
    uint8_t *known = malloc(count);
    if (!known)
        return weft_fail_memory(error, "pictures", count);
    for (size_t i = 0; i < count; i++)
        known[i] = pair->mask[i] == 0;
    weft_code code = weft_picture_quality_by_region(sample, predicted, known, 1, &one, &pixels, error);
    free(known);
    WEFT_TRY(code);
    measured->picture_count++;
    measured->picture_pixels += pixels;
    double share = pixels > 0 ? (double)pixels / (double)measured->picture_pixels : 0;
    mean->psnr_db += share * (fmin(one.psnr_db, largest_psnr_db) - mean->psnr_db);
    mean->ssim += share * (one.ssim - mean->ssim);
    mean->flip += share * (one.flip - mean->flip);
    return WEFT_OK;
}

/* The pictures become those of `measured` where they are to be kept. */
static weft_code compare_shown(const weft_image_pair *pair, double exposure, bool keep, weft_held_error *measured,
                               weft_error *error)
{
    weft_image sample = {0}, predicted = {0};
    weft_code code = weft_picture_encode(&pair->sample, NULL, exposure, &sample, error);
    if (code == WEFT_OK)
        code = weft_picture_encode(&pair->prediction, NULL, exposure, &predicted, error);
    if (code == WEFT_OK)
        code = measure_quality(&sample, &predicted, pair, measured, error);
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

static weft_code compare_image(const weft_trial *trial, const weft_asked_samples *said, int image, double *worst,
                               weft_held_error *measured, weft_error *error)
{
    weft_image_pair pair;
    weft_error_summary summary;
    double exposure;
    weft_dataset_layout shown = trial->subset->layout;
    shown.width = trial->asked.width;
    shown.height = trial->asked.height;
    weft_code code = weft_image_pair_create(&shown, image, &pair, error);
    if (code == WEFT_OK) {
        fill(trial, said, &pair);
        code = weft_image_pair_error(&pair, &summary, error);
    }
    if (code == WEFT_OK)
        code = weft_picture_exposure(&pair.sample, pair.mask, &exposure, error);
    if (code == WEFT_OK && summary.count > 0) {
        bool is_worst = summary.relative_rmse > *worst;
        *worst = is_worst ? summary.relative_rmse : *worst;
        code = compare_shown(&pair, exposure, is_worst, measured, error);
    }
    weft_image_pair_free(&pair);
    return code;
}

weft_code weft_held_pictures_compare(const weft_trial *trial, const weft_asked_samples *said, weft_held_error *measured,
                                     weft_error *error)
{
    int image[WEFT_HELD_PICTURES], count = weft_held_pictures_choose(trial, image);
    double worst = -1;
    for (int i = 0; i < count; i++)
        WEFT_TRY(compare_image(trial, said, image[i], &worst, measured, error));
    return WEFT_OK;
}
