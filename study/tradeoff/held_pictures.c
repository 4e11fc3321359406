#include "study/tradeoff/held_pictures.h"

#include "study/error/image_pair.h"
#include "study/error/sample_picture.h"

#include <math.h>
#include <string.h>

enum { MOST_PICTURES = 8 };

/* Of pictures that are equal, in a mean. */
static const double largest_psnr_db = 99;

/* Of the images with the most reasons to be held out so many, evenly. */
static int choose_images(const weft_trial *trial, int image[MOST_PICTURES])
{
    int most = 0, candidates = 0, count = 0;
    for (int i = 0; i < trial->held_count; i++)
        most = trial->flags[i] > most ? trial->flags[i] : most;
    for (int i = 0; i < trial->held_count; i++)
        candidates += trial->flags[i] == most;
    int wanted = candidates < MOST_PICTURES ? candidates : MOST_PICTURES;
    for (int i = 0, seen = 0; i < trial->held_count; i++) {
        if (trial->flags[i] == most && (long)seen++ * wanted / candidates == count && count < wanted)
            image[count++] = trial->image[i];
    }
    return count;
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

static void take_quality(const weft_picture_quality *one, weft_held_error *measured)
{
    weft_picture_quality *mean = &measured->quality;
    double share = 1.0 / ++measured->picture_count;
    mean->psnr_db += share * (fmin(one->psnr_db, largest_psnr_db) - mean->psnr_db);
    mean->ssim += share * (one->ssim - mean->ssim);
    mean->flip += share * (one->flip - mean->flip);
}

/* The pictures become those of `measured` where they are to be kept. */
static weft_code compare_shown(const weft_image_pair *pair, double exposure, bool keep, weft_held_error *measured,
                               weft_error *error)
{
    weft_image sample = {0}, predicted = {0};
    weft_picture_quality quality;
    weft_code code = weft_picture_encode(&pair->sample, NULL, exposure, &sample, error);
    if (code == WEFT_OK)
        code = weft_picture_encode(&pair->prediction, NULL, exposure, &predicted, error);
    if (code == WEFT_OK)
        code = weft_picture_quality_measure(&sample, &predicted, &quality, error);
    if (code == WEFT_OK)
        take_quality(&quality, measured);
    if (code == WEFT_OK && keep) {
        weft_held_error_free(measured);
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
    weft_dataset_layout shown = trial->excerpt->layout;
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
    int image[MOST_PICTURES], count = choose_images(trial, image);
    double worst = -1;
    for (int i = 0; i < count; i++)
        WEFT_TRY(compare_image(trial, said, image[i], &worst, measured, error));
    return WEFT_OK;
}
