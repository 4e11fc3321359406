#include "study/prune/shrink.h"

#include "btf/material/layer_rounding.h"
#include "study/prune/images.h"

#include <stdlib.h>
#include <string.h>

/* Images may use so much of what is allowed. Digits may use all of the rest: a layer that they leave anything of costs
 * few bytes, and what goes with it shows more at moments that are not looked at. */
static const double share_of_images = 0.35;
static const double margin_deg[] = {20, 40};
static const double finest_step = 1e-4, step_ratio = 1.1;

enum { MARGINS = 2, STEPS = 82 /* the coarsest: a fifth of white */ };

typedef struct shrinking {
    const weft_prune_pictures *pictures;
    const weft_reach *reach;
    weft_prune_error allowed;
    weft_material *material;
    weft_layers *before; /* the layers before a step */
    weft_prune_report *report;
} shrinking;

static bool is_within(const weft_prune_error *is, const weft_prune_error *allowed, double share)
{
    return is->rmse <= share * allowed->rmse && is->flip <= share * allowed->flip;
}

/* What pictures say of the material as it is. */
static weft_code look(const shrinking *s, int layers, weft_prune_error *is, weft_error *error)
{
    WEFT_TRY(weft_player_set_material(s->pictures->player, s->material, error));
    return weft_prune_pictures_compare(s->pictures, layers, is, error);
}

/* The material has a copy of the first `count` layers before the step. */
static weft_code begin(shrinking *s, int count, weft_error *error)
{
    weft_layers_free(s->material->layers);
    s->material->layers = NULL;
    return weft_prune_copy_layers(s->before, count, &s->material->layers, error);
}

/* Now they are those before the next step. */
static weft_code settle(shrinking *s, weft_error *error)
{
    weft_layers_free(s->before);
    s->before = NULL;
    return weft_prune_copy_layers(s->material->layers, s->material->layers->layer_count, &s->before, error);
}

/* ---- Images ---- */

/* *enough: pictures allow it. */
static weft_code try_margin(shrinking *s, double margin_rad, bool *kept, bool *enough, weft_error *error)
{
    weft_prune_error is;
    int count;
    WEFT_TRY(begin(s, s->before->layer_count, error));
    WEFT_TRY(weft_prune_find_images(s->reach, s->before, margin_rad, kept, &count, error));
    s->report->images = (weft_prune_count){count, s->before->image_count};
    if (count == s->before->image_count) {
        *enough = true;
        return WEFT_OK;
    }
    weft_prune_fill_images(kept, s->material->layers);
    WEFT_TRY(look(s, WEFT_LAYERS_MAX, &is, error));
    *enough = is_within(&is, &s->allowed, share_of_images);
    return WEFT_OK;
}

static weft_code prune_images(shrinking *s, weft_error *error)
{
    bool enough = false;
    bool *kept = calloc((size_t)s->before->image_count, sizeof *kept);
    weft_code code = kept ? WEFT_OK : weft_fail_memory(error, "images", (size_t)s->before->image_count);
    for (int i = 0; code == WEFT_OK && !enough && i < MARGINS; i++)
        code = try_margin(s, weft_rad_of_deg(margin_deg[i]), kept, &enough, error);
    if (code == WEFT_OK && !enough) {
        s->report->images.kept = s->report->images.of;
        code = begin(s, s->before->layer_count, error);
    }
    free(kept);
    return code == WEFT_OK ? settle(s, error) : code;
}

/* ---- Digits ---- */

static double step_of(int number)
{
    return finest_step * pow(step_ratio, number);
}

/* Pictures say what may go, whatever level they ask for. */
static void round_layers(double step, weft_layers *layers)
{
    weft_layers_round_values(step, layers);
    weft_layers_round_coefficients(step, false, layers);
}

/* The largest step that pictures allow, found by halving; -1: not even the finest. */
static weft_code round_values(shrinking *s, weft_error *error)
{
    int low = -1, high = STEPS;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        weft_prune_error is;
        WEFT_TRY(begin(s, s->before->layer_count, error));
        round_layers(step_of(middle), s->material->layers);
        WEFT_TRY(look(s, WEFT_LAYERS_MAX, &is, error));
        *(is_within(&is, &s->allowed, 1) ? &low : &high) = middle;
    }
    WEFT_TRY(begin(s, s->before->layer_count, error));
    s->report->value_step = low < 0 ? 0 : step_of(low);
    if (low >= 0)
        round_layers(step_of(low), s->material->layers);
    return settle(s, error);
}

/* ---- Layers ---- */

/* The least number of them that pictures allow, found by halving: the player draws any. */
static weft_code prune_layers(shrinking *s, weft_error *error)
{
    int low = 0, high = s->before->layer_count / WEFT_LAYERS_GROUP, all = s->before->layer_count;
    WEFT_TRY(weft_player_set_material(s->pictures->player, s->material, error));
    while (high - low > 1) {
        int middle = (low + high) / 2;
        weft_prune_error is;
        WEFT_TRY(weft_prune_pictures_compare(s->pictures, middle * WEFT_LAYERS_GROUP, &is, error));
        *(is_within(&is, &s->allowed, 1) ? &high : &low) = middle;
    }
    s->report->layers = (weft_prune_count){(long)high * WEFT_LAYERS_GROUP, all};
    return begin(s, high * WEFT_LAYERS_GROUP, error);
}

weft_code weft_prune_shrink(const weft_prune_pictures *pictures, const weft_reach *reach, weft_prune_error allowed,
                            weft_material *material, weft_prune_report *report, weft_error *error)
{
    shrinking s = {pictures, reach, allowed, material, NULL, report};
    weft_code code = settle(&s, error);
    if (code == WEFT_OK)
        code = prune_images(&s, error);
    if (code == WEFT_OK)
        code = round_values(&s, error);
    if (code == WEFT_OK)
        code = prune_layers(&s, error);
    if (code == WEFT_OK)
        code = look(&s, WEFT_LAYERS_MAX, &report->predicted, error);
    weft_layers_free(s.before);
    return code;
}
