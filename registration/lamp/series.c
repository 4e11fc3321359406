#include "base/numeric/statistics.h"
#include "registration/lamp/lamp.h"

#include <math.h>
#include <stdlib.h>

/* One view: the camera within a degree and a hundredth of its distance. */
static const double view_deg = 1, distance_share = 0.01;

/* Exposures differ where one is this many times the other. The logarithm of the ratio of light that is decoded as sRGB
 * is between a half and twice of theirs, for the tone curve is not known yet. A camera that exposes by itself makes up
 * for another lamp: then both have the same light. */
static const double least_ratio = 1.4, least_contrast = 0.5, most_contrast = 2;

/* One light: what a place has in one photograph follows from what it has in the other, within this much of it. */
static const double most_scatter = 0.03;
enum { FEWEST_PLACES = 40 };

static bool is_one_view(const weft_pose *a, const weft_pose *b)
{
    weft_vec3 p = weft_pose_camera_position(a), q = weft_pose_camera_position(b);
    return weft_dot(weft_unit(p), weft_unit(q)) > cos(weft_rad_of_deg(view_deg)) &&
           fabs(log(weft_length(p) / weft_length(q))) < distance_share;
}

/* Logarithms of the light of a place in both photographs. */
typedef struct both {
    double bright, dark;
} both;

static int by_bright(const void *left, const void *right)
{
    double a = ((const both *)left)->bright, b = ((const both *)right)->bright;
    return (a > b) - (a < b);
}

/* Places that both photographs show, by their light in the brighter one. Samples are in the order of their places. */
static size_t find_common(const weft_paper_samples *bright, const weft_paper_samples *dark, both *place)
{
    size_t count = 0;
    for (int i = 0, k = 0; i < bright->count && k < dark->count;) {
        const weft_paper_sample *a = &bright->sample[i], *b = &dark->sample[k];
        if (a->place == b->place && a->light[1] > 0 && b->light[1] > 0)
            place[count++] = (both){log((double)a->light[1]), log((double)b->light[1])};
        i += a->place <= b->place;
        k += b->place <= a->place;
    }
    qsort(place, count, sizeof *place, by_bright);
    return count;
}

/* Standard deviation of the dark photograph's light about a smooth function of the bright one's: every place lies
 * between its neighbours in brightness, which lie elsewhere on the sheet. */
static double scatter(const both *place, size_t count, double *scratch)
{
    for (size_t i = 1; i + 1 < count; i++)
        scratch[i - 1] = fabs(place[i].dark - 0.5 * (place[i - 1].dark + place[i + 1].dark));
    return 1.4826 / sqrt(1.5) * weft_quantile(scratch, count - 2, 0.5);
}

static double median_ratio(const both *place, size_t count, double *scratch)
{
    for (size_t i = 0; i < count; i++)
        scratch[i] = place[i].bright - place[i].dark;
    return weft_quantile(scratch, count, 0.5);
}

static bool is_one_light(const weft_lamp_evidence *bright, const weft_lamp_evidence *dark, both *place, double *scratch)
{
    size_t count = find_common(&bright->paper, &dark->paper, place);
    double written = log(bright->exposure / dark->exposure), seen = median_ratio(place, count, scratch);
    return count >= FEWEST_PLACES && seen > least_contrast * written && seen < most_contrast * written &&
           scatter(place, count, scratch) < most_scatter;
}

/* The next darker photograph of what `bright` shows; -1: none. */
static int next_darker(const weft_lamp_problem *problem, int bright, both *place, double *scratch)
{
    const weft_lamp_evidence *from = &problem->evidence[bright];
    int next = -1;
    for (int i = 0; i < problem->count; i++) {
        const weft_lamp_evidence *evidence = &problem->evidence[i];
        if (evidence->exposure > 0 && evidence->exposure * least_ratio < from->exposure &&
            (next < 0 || evidence->exposure > problem->evidence[next].exposure) &&
            is_one_view(&from->pose, &evidence->pose) && is_one_light(from, evidence, place, scratch))
            next = i;
    }
    return next;
}

weft_code weft_exposure_pairs_find(const weft_lamp_problem *problem, weft_exposure_pair *pair, int *count,
                                   weft_error *error)
{
    size_t places = (size_t)problem->places->count;
    both *place = malloc(places * sizeof *place);
    double *scratch = malloc(places * sizeof *scratch);
    *count = 0;
    if (!place || !scratch) {
        free(place);
        free(scratch);
        return weft_fail_memory(error, "exposures", places * sizeof *place);
    }
    for (int i = 0; i < problem->count; i++) {
        int dark = next_darker(problem, i, place, scratch);
        if (dark >= 0)
            pair[(*count)++] =
                (weft_exposure_pair){i, dark, log(problem->evidence[i].exposure / problem->evidence[dark].exposure)};
    }
    free(place);
    free(scratch);
    return WEFT_OK;
}
