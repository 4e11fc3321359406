#include "edit/prune/prune.h"

#include "edit/prune/steps.h"

enum { ATTEMPTS = 3, DECIDING = 3, MOST_ALLOWANCE = 4 };

static const double reserve = 0.9; /* of what is allowed: the rest is for other moments */
static const double less = 0.8;    /* of what was asked, where other moments show more */

/* The slope of sRGB at black: a value of linear radiance changes a pixel by no more than this many times itself. */
static const double steepest_srgb = 12.92;

/* ---- Moments ---- */

static double start_s(const weft_prune_scene *scene)
{
    return scene->path ? scene->path->time_s[0] : 0;
}

static double length_s(const weft_prune_scene *scene)
{
    return scene->path ? scene->path->time_s[scene->path->key_count - 1] - scene->path->time_s[0] : 0;
}

/* Evenly from the first key to the last; a scene that stands still has one. */
static int even_times(const weft_prune_scene *scene, double time_s[WEFT_PRUNE_MOMENTS])
{
    int count = length_s(scene) > 0 ? DECIDING : 1;
    for (int i = 0; i < count; i++)
        time_s[i] = start_s(scene) + (count > 1 ? length_s(scene) * i / (count - 1) : 0);
    return count;
}

/* One in each of as many parts of the path (Knuth's multiplicative generator of 64 bits). */
static int random_times(const weft_prune_scene *scene, uint64_t *seed, double time_s[WEFT_PRUNE_MOMENTS])
{
    int count = length_s(scene) > 0 ? WEFT_PRUNE_MOMENTS : 1;
    for (int i = 0; i < count; i++) {
        *seed = *seed * 6364136223846793005u + 1442695040888963407u;
        double chance = (double)(*seed >> 11) * 0x1p-53;
        time_s[i] = start_s(scene) + length_s(scene) * (i + chance) / count;
    }
    return count;
}

/* ---- What bounds allow ---- */

static long cells_above_horizon(const uint8_t *cells, long *all)
{
    long count = 0;
    for (int i = 0; i < WEFT_VISIBILITY_SIDE * WEFT_VISIBILITY_SIDE; i++) {
        double x = (i % WEFT_VISIBILITY_SIDE + 0.5) / WEFT_VISIBILITY_SIDE - 0.5;
        double y = ((int)(i / WEFT_VISIBILITY_SIDE) + 0.5) / WEFT_VISIBILITY_SIDE - 0.5;
        bool above = x * x + y * y < 0.25;
        *all += above;
        count += above && cells[i];
    }
    return count;
}

static void note_visibility(const weft_visibility *visibility, weft_prune_report *report)
{
    report->level_low = visibility->level_low;
    report->level_high = fmin(visibility->level_high, visibility->level_count - 1);
    report->span_count = visibility->span_count;
    for (int k = 0; k < visibility->level_count; k++) {
        report->texels.kept += visibility->texel_count[k];
        report->texels.of += (long)visibility->width[k] * visibility->height[k];
    }
    report->view_cells.kept = cells_above_horizon(visibility->view, &report->view_cells.of);
    report->light_cells.kept = cells_above_horizon(visibility->light, &report->light_cells.of);
}

/* Light of all lamps together may show a lobe so bright. */
static double brightness(const weft_prune_scene *scene)
{
    double sum = 0;
    for (int i = 0; i < scene->scene.light_count; i++) {
        const double *irradiance = scene->scene.light[i].irradiance;
        sum += fmax(irradiance[0], fmax(irradiance[1], irradiance[2]));
    }
    return fmax(sum * scene->scene.exposure, 1e-9);
}

static weft_code prune_by_bounds(const weft_prune_scene *scene, weft_prune_error allowed, weft_visibility *visibility,
                                 weft_material *material, weft_prune_report *report, weft_error *error)
{
    report->views.of = material->view_count;
    note_visibility(visibility, report);
    WEFT_TRY(weft_prune_texels(visibility, material, &report->finer_levels, &report->coarser_levels, error));
    WEFT_TRY(weft_prune_tables(visibility, material, error));
    if (!scene->scene.environment)
        weft_prune_lobes(visibility, allowed.rmse / 255 / steepest_srgb / brightness(scene), material,
                         &report->lobes_gone);
    report->views.kept = material->view_count;
    return weft_prune_note_seen(visibility, report->finer_levels, report->coarser_levels, material, error);
}

/* ---- What pictures allow ---- */

static weft_code measure(const weft_prune_pictures *pictures, weft_prune_report *report, weft_error *error)
{
    report->measured_count = pictures->count;
    for (int i = 0; i < pictures->count; i++)
        report->measured_time_s[i] = pictures->time_s[i];
    return weft_prune_pictures_compare(pictures, WEFT_COMPONENTS_MAX, &report->measured, error);
}

/* Components are pruned from `whole`. */
static weft_code attempt(const weft_prune_pictures *deciding, const weft_visibility *visibility,
                         const weft_components *whole, weft_prune_error allowed, weft_material *material,
                         weft_prune_report *report, weft_error *error)
{
    if (whole) {
        weft_components_free(material->components);
        material->components = NULL;
        WEFT_TRY(weft_prune_copy_components(whole, whole->component_count, &material->components, error));
        report->components = (weft_prune_count){whole->component_count, whole->component_count};
        report->images = (weft_prune_count){whole->image_count, whole->image_count};
        report->value_step = 0;
    }
    if (whole && allowed.rmse > 0) {
        WEFT_TRY(weft_prune_shrink(deciding, visibility, allowed, material, report, error));
    } else {
        WEFT_TRY(weft_player_set_material(deciding->player, material, error));
        WEFT_TRY(weft_prune_pictures_compare(deciding, WEFT_COMPONENTS_MAX, &report->predicted, error));
    }
    return WEFT_OK;
}

/* By how much more than the few frames that decide, whole pictures of these moments allow. */
static double allowance(const weft_prune_error *is, const weft_prune_error *allowed)
{
    double rmse = is->rmse > 0 ? allowed->rmse / is->rmse : MOST_ALLOWANCE;
    double flip = is->flip > 0 ? allowed->flip / is->flip : MOST_ALLOWANCE;
    return weft_clamp(reserve * fmin(rmse, flip), 1.0 / MOST_ALLOWANCE, MOST_ALLOWANCE);
}

bool weft_prune_holds(const weft_prune_report *report)
{
    const double rounding_rmse = 1e-3, rounding_flip = 1e-4;
    return report->measured.rmse <= report->allowed.rmse + rounding_rmse &&
           report->measured.flip <= report->allowed.flip + rounding_flip;
}

/* First by what is allowed itself; then by what whole pictures make of that; then, where other moments show more, by
 * less of it, in the end by nothing. */
static weft_code prune_by_pictures(const weft_prune_pictures pictures[3], const weft_visibility *visibility,
                                   const weft_components *whole, const weft_progress *progress, weft_material *material,
                                   weft_prune_report *report, weft_error *error)
{
    weft_prune_error asked = report->allowed;
    bool enough = false;
    for (int i = 0; !enough && i <= ATTEMPTS; i++) {
        weft_progress_report(progress, "trying what pictures allow", i, ATTEMPTS + 1);
        asked = i == ATTEMPTS ? (weft_prune_error){0} : asked;
        WEFT_TRY(attempt(&pictures[0], visibility, whole, asked, material, report, error));
        WEFT_TRY(weft_prune_pictures_compare(&pictures[1], WEFT_COMPONENTS_MAX, &report->predicted, error));
        double factor = i == 0 && whole ? allowance(&report->predicted, &report->allowed) : less;
        asked = (weft_prune_error){factor * asked.rmse, factor * asked.flip};
        if (i == 0 && whole && report->allowed.rmse > 0)
            continue;
        WEFT_TRY(measure(&pictures[2], report, error));
        enough = !whole || weft_prune_holds(report);
    }
    weft_progress_report(progress, "trying what pictures allow", ATTEMPTS + 1, ATTEMPTS + 1);
    return WEFT_OK;
}

static weft_code draw_moments(weft_player *player, const weft_prune_scene *scene, uint64_t seed,
                              weft_prune_pictures pictures[3], weft_prune_report *report, weft_error *error)
{
    double time_s[WEFT_PRUNE_MOMENTS];
    report->decided_count = even_times(scene, time_s);
    WEFT_TRY(weft_prune_pictures_draw(player, scene, false, time_s, report->decided_count, &pictures[0], error));
    int count = report->decided_count > 1 ? report->decided_count - 1 : 1;
    WEFT_TRY(weft_prune_pictures_draw(player, scene, true, time_s, count, &pictures[1], error));
    count = random_times(scene, &seed, time_s);
    return weft_prune_pictures_draw(player, scene, true, time_s, count, &pictures[2], error);
}

static weft_code prune(weft_player *player, const weft_prune_scene *scene, uint64_t seed, weft_visibility *visibility,
                       weft_prune_pictures pictures[3], const weft_progress *progress, weft_material *material,
                       weft_prune_report *report, weft_error *error)
{
    weft_components *whole = NULL;
    WEFT_TRY(draw_moments(player, scene, seed, pictures, report, error));
    WEFT_TRY(prune_by_bounds(scene, report->allowed, visibility, material, report, error));
    if (material->components)
        WEFT_TRY(
            weft_prune_copy_components(material->components, material->components->component_count, &whole, error));
    weft_code code = prune_by_pictures(pictures, visibility, whole, progress, material, report, error);
    weft_components_free(whole);
    return code;
}

weft_code weft_prune(weft_player *player, const weft_prune_scene *scene, weft_prune_error allowed, uint64_t seed,
                     const weft_progress *progress, weft_material *material, weft_prune_report *report,
                     weft_error *error)
{
    weft_visibility visibility;
    weft_prune_pictures pictures[3] = {0};
    *report = (weft_prune_report){.allowed = allowed};
    if (material->visibility)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "the material was already pruned for a scene; prune the whole material instead");
    WEFT_TRY(weft_material_size(material, &report->bytes_before, error));
    WEFT_TRY(weft_visibility_find(scene, material, progress, &visibility, error));
    weft_code code = prune(player, scene, seed, &visibility, pictures, progress, material, report, error);
    for (int i = 0; i < 3; i++)
        weft_prune_pictures_free(&pictures[i]);
    weft_visibility_free(&visibility);
    return code == WEFT_OK ? weft_material_size(material, &report->bytes_after, error) : code;
}

/* ---- The metadata ---- */

static json_t *pack_count(weft_prune_count count)
{
    return json_pack("[I, I]", (json_int_t)count.kept, (json_int_t)count.of);
}

static json_t *pack_error(weft_prune_error error)
{
    return json_pack("{s:f, s:f}", "rmse_of_255", error.rmse, "flip", error.flip);
}

json_t *weft_prune_to_json(const weft_prune_report *r)
{
    return json_pack(
        "{s:[f, f], s:[i, i], s:o, s:o, s:I, s:o, s:o, s:f, s:[I, I], s:o, s:o, s:o, s:i}", "levels_of_pixels",
        r->level_low, r->level_high, "levels_gone", r->finer_levels, r->coarser_levels, "texels", pack_count(r->texels),
        "views", pack_count(r->views), "lobes_gone", (json_int_t)r->lobes_gone, "components", pack_count(r->components),
        "images", pack_count(r->images), "value_step", r->value_step, "bytes", (json_int_t)r->bytes_after,
        (json_int_t)r->bytes_before, "allowed", pack_error(r->allowed), "predicted", pack_error(r->predicted),
        "measured", pack_error(r->measured), "moments_measured", r->measured_count);
}
