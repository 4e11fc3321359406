#include "registration/photographs/steps.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

weft_code weft_photographs_contradict(const char *folder, const weft_photographs_settings *settings,
                                      weft_photograph_set *set, weft_error *error, const char *format, ...)
{
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (settings->force)
        return weft_lines_add(&set->notes, error, "%s", text);
    return weft_fail(error, WEFT_BAD_INPUT, "'%s': %s; --force writes the dataset all the same", folder, text);
}

/* ---- Files of several sizes ---- */

weft_code weft_photographs_check_sizes(const char *folder, const weft_photographs_settings *settings,
                                       const weft_exif *common, weft_photograph_set *set, weft_error *error)
{
    const double most_share = 0.2;
    int others = 0, first = -1;
    for (int i = 0; i < set->count; i++) {
        const weft_exif *exif = &set->photograph[i].exif;
        if (exif->width <= 0 || (exif->width == common->width && exif->height == common->height))
            continue;
        first = others++ ? first : i;
    }
    if (others <= most_share * set->count)
        return WEFT_OK;
    const weft_photographs_photograph *p = &set->photograph[first];
    return weft_photographs_contradict(folder, settings, set, error,
                                       "%d of %d photographs have another size than %d x %d pixels, such as '%.80s' "
                                       "with %d x %d: a program resized, cropped or turned them. Copy the files as the "
                                       "camera wrote them",
                                       others, set->count, common->width, common->height, p->name, p->exif.width,
                                       p->exif.height);
}

/* ---- Too little paper ---- */

void weft_photographs_say_paperless(const weft_paper_samples *paper, weft_photographs_photograph *photograph)
{
    static const char *const reason[WEFT_PAPER_FATES] = {
        "", "too little of the sheet is in the picture", "the sheet is too small in it, or seen too much from the side",
        "its paper is overexposed", "its paper is too dark to be read"};
    int worst = WEFT_PAPER_OUTSIDE, all = paper->count;
    for (int fate = WEFT_PAPER_OUTSIDE; fate < WEFT_PAPER_FATES; fate++) {
        worst = paper->fate[fate] > paper->fate[worst] ? fate : worst;
        all += paper->fate[fate];
    }
    snprintf(photograph->remark, sizeof photograph->remark, "%s (%d of %d places); the light cannot be measured",
             reason[worst], paper->fate[worst], all);
}

/* ---- Two lenses ---- */

static double focal_length_of(const weft_photographs_photograph *p)
{
    return p->exif.focal_length_35mm > 0 ? p->exif.focal_length_35mm : p->exif.focal_length_mm;
}

static bool is_one_lens(double a, double b)
{
    const double rounding = 0.03;
    return fabs(a - b) <= rounding * b;
}

void weft_photographs_leave_out_other_lenses(weft_photograph_set *set)
{
    double common = 0;
    int most = 0;
    for (int i = 0; i < set->count; i++) {
        double focal = focal_length_of(&set->photograph[i]);
        int same = 0;
        for (int k = 0; k < set->count; k++)
            same +=
                weft_photographs_used(&set->photograph[k]) && is_one_lens(focal_length_of(&set->photograph[k]), focal);
        if (focal > 0 && same > most)
            most = same, common = focal;
    }
    for (int i = 0; i < set->count; i++) {
        weft_photographs_photograph *p = &set->photograph[i];
        double focal = focal_length_of(p);
        if (weft_photographs_used(p) && focal > 0 && !is_one_lens(focal, common))
            snprintf(p->remark, sizeof p->remark,
                     "it was taken with another lens or zoom: %.4g mm, most with %.4g mm; photographs of another lens "
                     "need a folder of their own",
                     focal, common);
    }
}

/* ---- Lamps ---- */

/* Logarithm of the power of the lamp, for the exposure that the camera wrote; NaN where it wrote none. */
static double log_power(const weft_photographs_photograph *p)
{
    double exposure = weft_exif_exposure(&p->exif);
    return exposure > 0 && p->lamp.level[1] > 0
               ? log(p->lamp.level[1] * weft_dot(p->lamp.position_mm, p->lamp.position_mm) / exposure)
               : NAN;
}

void weft_photographs_leave_out_unlit(weft_photograph_set *set)
{
    const double least_share = 0.2;
    double *power = malloc(((size_t)set->count + 1) * sizeof *power);
    size_t count = 0;
    for (int i = 0; power && i < set->count; i++) {
        double one = log_power(&set->photograph[i]);
        if (weft_photographs_used(&set->photograph[i]) && isfinite(one))
            power[count++] = one;
    }
    double usual = count >= WEFT_PHOTOGRAPHS_FEWEST ? weft_quantile(power, count, 0.5) : NAN;
    free(power);
    for (int i = 0; i < set->count; i++) {
        weft_photographs_photograph *p = &set->photograph[i];
        double share = exp(log_power(p) - usual);
        if (weft_photographs_used(p) && share < least_share)
            snprintf(p->remark, sizeof p->remark,
                     "its light is %.1f %% of that of the others at the same exposure: the lamp was off, or shaded",
                     100 * share);
    }
}

weft_code weft_photographs_check_flash(const char *folder, const weft_photographs_settings *settings,
                                       weft_photograph_set *set, weft_error *error)
{
    const double near_rad = weft_rad_of_deg(12), steep_rad = weft_rad_of_deg(25), most_share = 0.9;
    int used = 0, near = 0, steep = 0;
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        if (!weft_photographs_used(p))
            continue;
        weft_vec3 eye = weft_unit(weft_pose_camera_position(&p->pose));
        used++;
        near += weft_dot(eye, weft_unit(p->lamp.position_mm)) > cos(near_rad);
        steep += eye.z < cos(steep_rad);
    }
    if (settings->flash || steep < 2 || near < most_share * used)
        return WEFT_OK;
    return weft_photographs_contradict(folder, settings, set, error,
                                       "the lamp stood beside the camera in %d of %d photographs: if it is the "
                                       "camera's flash, pass --flash",
                                       near, used);
}

/* ---- A sample that moved ---- */

/* Deviations of the green of a small picture from its mean, with unit variance; NULL where it is even or memory is
 * short. */
static double *pattern_of(const weft_image *image)
{
    long count = (long)image->width * image->height;
    double sum = 0, squares = 0, *pattern = image->pixels ? calloc((size_t)count, sizeof *pattern) : NULL;
    for (long i = 0; pattern && i < count; i++) {
        pattern[i] = (double)image->pixels[3 * i + 1];
        sum += pattern[i];
        squares += pattern[i] * pattern[i];
    }
    double mean = sum / (double)count, deviation = sqrt(fmax(0, squares / (double)count - mean * mean));
    for (long i = 0; pattern && i < count; i++)
        pattern[i] = deviation > 1e-3 ? (pattern[i] - mean) / deviation : 0;
    return pattern;
}

/* Correlation of two patterns, the second moved by (dx, dy). */
static double correlation(const double *a, const double *b, int width, int height, int dx, int dy)
{
    double sum = 0, aa = 0, bb = 0;
    for (int y = dy > 0 ? dy : 0; y < height + (dy < 0 ? dy : 0); y++) {
        for (int x = dx > 0 ? dx : 0; x < width + (dx < 0 ? dx : 0); x++) {
            double p = a[(long)y * width + x], q = b[(long)(y - dy) * width + x - dx];
            sum += p * q, aa += p * p, bb += q * q;
        }
    }
    return aa > 0 && bb > 0 ? sum / sqrt(aa * bb) : 0;
}

/* How far b lies from a, in pixels of the small pictures; 0 where it is not clear that it does. */
static double shift_between(const double *a, const double *b, int width, int height)
{
    const double least_correlation = 0.5, least_gain = 0.15;
    const int reach = width / 8;
    double best = -1, shift = 0, still = correlation(a, b, width, height, 0, 0);
    for (int dy = -reach; dy <= reach; dy++) {
        for (int dx = -reach; dx <= reach; dx++) {
            double one = correlation(a, b, width, height, dx, dy);
            if (one > best)
                best = one, shift = hypot(dx, dy);
        }
    }
    return best > least_correlation && best > still + least_gain ? shift : 0;
}

/* Whether a pattern resembles itself elsewhere, as that of a woven cloth: then a shift says nothing. */
static bool repeats(const double *pattern, int width, int height)
{
    const double most_correlation = 0.4, least_shift = 5;
    const int reach = width / 8;
    for (int dy = 0; dy <= reach; dy++) {
        for (int dx = -reach; dx <= reach; dx++) {
            if (hypot(dx, dy) >= least_shift && correlation(pattern, pattern, width, height, dx, dy) > most_correlation)
                return true;
        }
    }
    return false;
}

/* The photograph from most nearly above. */
static const weft_photographs_photograph *find_reference(const weft_photograph_set *set)
{
    const weft_photographs_photograph *best = NULL;
    double most = -1;
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        if (!weft_photographs_used(p) || !p->rectified.pixels)
            continue;
        double upright = weft_unit(weft_pose_camera_position(&p->pose)).z;
        if (upright > most)
            most = upright, best = p;
    }
    return best;
}

weft_code weft_photographs_check_still(const char *folder, const weft_photographs_settings *settings,
                                       weft_photograph_set *set, weft_error *error)
{
    const double most_share = 0.15;
    const weft_photographs_photograph *reference = find_reference(set);
    double *shift = calloc((size_t)set->count + 1, sizeof *shift);
    double *still = reference ? pattern_of(&reference->rectified) : NULL, mm = 0;
    int used = 0, moved = 0, first = -1;
    if (still && repeats(still, reference->rectified.width, reference->rectified.height)) {
        free(shift);
        free(still);
        return WEFT_OK;
    }
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        double *pattern = shift && still && weft_photographs_used(p) ? pattern_of(&p->rectified) : NULL;
        if (pattern)
            shift[i] = shift_between(still, pattern, p->rectified.width, p->rectified.height) *
                       settings->target.opening_mm / p->rectified.width;
        free(pattern);
    }
    for (int i = 0; shift && i < set->count; i++) {
        used += weft_photographs_used(&set->photograph[i]);
        if (!(shift[i] > 0))
            continue;
        first = moved++ ? first : i;
        mm += shift[i];
    }
    free(shift);
    free(still);
    if (moved < WEFT_PHOTOGRAPHS_FEWEST || moved < most_share * used)
        return WEFT_OK;
    return weft_photographs_contradict(folder, settings, set, error,
                                       "the sample moved under the sheet: in %d of %d photographs, such as '%.80s', it "
                                       "lies %.1f mm from where it lies in '%.80s'. Use one part of them",
                                       moved, used, set->photograph[first].name, mm / moved, reference->name);
}
