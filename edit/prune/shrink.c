#include "edit/prune/steps.h"

#include "btf/material/component_rounding.h"

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
    const weft_visibility *visibility;
    weft_prune_error allowed;
    weft_material *material;
    weft_components *before; /* the components before a step */
    weft_prune_report *report;
} shrinking;

static bool is_within(const weft_prune_error *is, const weft_prune_error *allowed, double share)
{
    return is->rmse <= share * allowed->rmse && is->flip <= share * allowed->flip;
}

/* What pictures say of the material as it is. */
static weft_code look(const shrinking *s, int components, weft_prune_error *is, weft_error *error)
{
    WEFT_TRY(weft_player_set_material(s->pictures->player, s->material, error));
    return weft_prune_pictures_compare(s->pictures, components, is, error);
}

/* The material has a copy of the first `count` components before the step. */
static weft_code begin(shrinking *s, int count, weft_error *error)
{
    weft_components_free(s->material->components);
    s->material->components = NULL;
    return weft_prune_copy_components(s->before, count, &s->material->components, error);
}

/* Now they are those before the next step. */
static weft_code settle(shrinking *s, weft_error *error)
{
    weft_components_free(s->before);
    s->before = NULL;
    return weft_prune_copy_components(s->material->components, s->material->components->component_count, &s->before,
                                      error);
}

/* ---- Images ---- */

/* *enough: pictures allow it. */
static weft_code try_margin(shrinking *s, double margin_rad, bool *kept, bool *enough, weft_error *error)
{
    weft_prune_error is;
    int count;
    WEFT_TRY(begin(s, s->before->component_count, error));
    WEFT_TRY(weft_prune_find_images(s->visibility, s->before, margin_rad, kept, &count, error));
    s->report->images = (weft_prune_count){count, s->before->image_count};
    if (count == s->before->image_count) {
        *enough = true;
        return WEFT_OK;
    }
    weft_prune_fill_images(kept, s->material->components);
    WEFT_TRY(look(s, WEFT_COMPONENTS_MAX, &is, error));
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
        code = begin(s, s->before->component_count, error);
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
static void round_components(double step, weft_components *components)
{
    weft_components_round_values(step, components);
    weft_components_round_coefficients(step, false, components);
}

/* The largest step that pictures allow, found by halving; -1: not even the finest. */
static weft_code round_values(shrinking *s, weft_error *error)
{
    int low = -1, high = STEPS;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        weft_prune_error is;
        WEFT_TRY(begin(s, s->before->component_count, error));
        round_components(step_of(middle), s->material->components);
        WEFT_TRY(look(s, WEFT_COMPONENTS_MAX, &is, error));
        *(is_within(&is, &s->allowed, 1) ? &low : &high) = middle;
    }
    WEFT_TRY(begin(s, s->before->component_count, error));
    s->report->value_step = low < 0 ? 0 : step_of(low);
    if (low >= 0)
        round_components(step_of(low), s->material->components);
    return settle(s, error);
}

/* ---- Components ---- */

/* The least number of them that pictures allow, found by halving: the player draws any. */
static weft_code prune_components(shrinking *s, weft_error *error)
{
    int low = 0, high = s->before->component_count / WEFT_COMPONENTS_GROUP, all = s->before->component_count;
    WEFT_TRY(weft_player_set_material(s->pictures->player, s->material, error));
    while (high - low > 1) {
        int middle = (low + high) / 2;
        weft_prune_error is;
        WEFT_TRY(weft_prune_pictures_compare(s->pictures, middle * WEFT_COMPONENTS_GROUP, &is, error));
        *(is_within(&is, &s->allowed, 1) ? &high : &low) = middle;
    }
    s->report->components = (weft_prune_count){(long)high * WEFT_COMPONENTS_GROUP, all};
    return begin(s, high * WEFT_COMPONENTS_GROUP, error);
}

weft_code weft_prune_shrink(const weft_prune_pictures *pictures, const weft_visibility *visibility,
                            weft_prune_error allowed, weft_material *material, weft_prune_report *report,
                            weft_error *error)
{
    shrinking s = {pictures, visibility, allowed, material, NULL, report};
    weft_code code = settle(&s, error);
    if (code == WEFT_OK)
        code = prune_images(&s, error);
    if (code == WEFT_OK)
        code = round_values(&s, error);
    if (code == WEFT_OK)
        code = prune_components(&s, error);
    if (code == WEFT_OK)
        code = look(&s, WEFT_COMPONENTS_MAX, &report->predicted, error);
    weft_components_free(s.before);
    return code;
}
