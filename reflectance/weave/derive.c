/* What follows from the text of a weave: which segments exist, their shares of the tile, their prepared constants. */
#include "base/text/text_file.h"
#include "btf/direction/direction.h"
#include "reflectance/weave/syntax.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Below this inclination a noisy yarn would turn into a mirror. */
#define MIN_NOISY_UMAX_DEG 1

/* Keeps width sin(umax) < length with room for the spine. */
#define MAX_NOISY_SINE 0.98

static void derive_umax_range(weft_yarn *yarn)
{
    const weft_segment *segment = &yarn->segment;
    weft_real largest_sine = (weft_real)MAX_NOISY_SINE * segment->length / segment->width;
    weft_real largest = largest_sine < 1 ? asin(largest_sine) : (weft_real)(WEFT_PI / 2);
    yarn->min_umax = fmin(weft_rad_of_deg(MIN_NOISY_UMAX_DEG), segment->umax);
    yarn->max_umax = fmax(largest, segment->umax);
}

static void derive_yarn(const weft_weave *weave, weft_yarn *yarn)
{
    weft_real area = yarn->warp ? weave->warp_area : weave->weft_area;
    yarn->area_weight = area > 0 ? (weave->warp_area + weave->weft_area) / area : 0;
    yarn->cell_fraction = 0;
    yarn->admissible = weft_segment_admissible(&yarn->segment);
    yarn->prepared = weft_segment_prepare(&yarn->segment);
    if (yarn->admissible)
        derive_umax_range(yarn);
}

static bool same_segment(const weft_segment *a, const weft_segment *b)
{
    return a->alpha == b->alpha && a->beta == b->beta && a->delta == b->delta && a->psi == b->psi &&
           a->umax == b->umax && a->kappa == b->kappa && a->width == b->width && a->length == b->length &&
           a->highlight_width == b->highlight_width && a->frozen_radius == b->frozen_radius;
}

/* A weave has few kinds of segments, however many yarns. */
static int first_alike(const weft_yarn *yarn, int index)
{
    for (int i = 0; i < index; i++)
        if (yarn[i].alike == i && yarn[i].warp == yarn[index].warp &&
            same_segment(&yarn[i].segment, &yarn[index].segment))
            return i;
    return index;
}

/* Appends to a line, cutting it where it is full. */
static void append_yarn(char line[WEFT_MESSAGE_SIZE], const weft_segment *segment, int id)
{
    size_t used = strlen(line);
    snprintf(line + used, WEFT_MESSAGE_SIZE - used, " %d (width %g, length %g, umax %g deg, kappa %g, psi %g deg);", id,
             (double)segment->width, (double)segment->length, (double)weft_deg_of_rad(segment->umax),
             (double)segment->kappa, (double)weft_deg_of_rad(segment->psi));
}

static void warn(const weft_weave *weave, const char *path, char warning[WEFT_MESSAGE_SIZE])
{
    warning[0] = '\0';
    for (int i = 0; i < weave->yarn_count; i++) {
        if (weave->yarn[i].admissible)
            continue;
        if (!warning[0])
            snprintf(warning, WEFT_MESSAGE_SIZE, "%s: the model has no such segment, highlight left out: yarn", path);
        append_yarn(warning, &weave->yarn[i].segment, i + 1);
    }
}

void weft_weave_derive(weft_weave *weave, const char *path, char warning[WEFT_MESSAGE_SIZE])
{
    int cells = weave->tile_width * weave->tile_height;
    for (int i = 0; i < weave->yarn_count; i++) {
        derive_yarn(weave, &weave->yarn[i]);
        weave->yarn[i].alike = first_alike(weave->yarn, i);
    }
    for (int cell = 0; cell < cells; cell++)
        weave->yarn[weave->pattern[cell]].cell_fraction += 1 / (weft_real)cells;
    if (warning)
        warn(weave, path, warning);
}

/* ---- Reading ---- */

weft_code weft_weave_parse(const char *text, const char *path, const weft_parameter *parameters, int parameter_count,
                           weft_weave *weave, char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    WEFT_TRY(weft_weave_parse_text(text, path, parameters, parameter_count, weave, error));
    weft_weave_derive(weave, path, warning);
    weave->specular_scale = weft_weave_specular_scale(weave);
    return WEFT_OK;
}

void weft_weave_update_yarns(weft_weave *weave)
{
    weft_weave_derive(weave, NULL, NULL);
}

void weft_weave_update(weft_weave *weave)
{
    weft_weave_update_yarns(weave);
    weave->specular_scale = weft_weave_specular_scale(weave);
}

weft_code weft_weave_copy(const weft_weave *from, weft_weave *to, weft_error *error)
{
    size_t cells = (size_t)from->tile_width * (size_t)from->tile_height, yarns = (size_t)from->yarn_count;
    *to = *from;
    to->pattern = malloc(cells * sizeof *to->pattern);
    to->yarn = malloc(yarns * sizeof *to->yarn);
    if (!to->pattern || !to->yarn) {
        weft_weave_free(to);
        return weft_fail_memory(error, "weave", cells * sizeof *to->pattern + yarns * sizeof *to->yarn);
    }
    memcpy(to->pattern, from->pattern, cells * sizeof *to->pattern);
    memcpy(to->yarn, from->yarn, yarns * sizeof *to->yarn);
    return WEFT_OK;
}

weft_code weft_weave_read(const char *path, const weft_parameter *parameters, int parameter_count, weft_weave *weave,
                          char warning[WEFT_MESSAGE_SIZE], weft_error *error)
{
    *weave = (weft_weave){0};
    char *text;
    WEFT_TRY(weft_text_file_read(path, &text, error));
    weft_code code = weft_weave_parse(text, path, parameters, parameter_count, weave, warning, error);
    free(text);
    return code;
}
