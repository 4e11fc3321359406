#include "registration/photographs/photographs.h"

#include "base/clock.h"
#include "registration/lamp/read.h"
#include "registration/photographs/steps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const what_helps = "see 'When it goes wrong' in docs/guide/photograph-your-cloth.md";

/* Everything at work. */
typedef struct work {
    const char *folder;
    const weft_photographs_settings *settings;
    const weft_progress *progress;
    weft_photograph_set *set;
    weft_paper_places places;
    weft_lamp_evidence *evidence; /* [count] */
    weft_reduced_sight sight;     /* while poses are refined */
    weft_pin_area pin_area;
    float **pin_patch; /* [count] around the pin; NULL: none */
} work;

weft_photographs_settings weft_photographs_defaults(void)
{
    return (weft_photographs_settings){
        weft_target_printed(50), 256, 256, 20, 30, false, false, false, 250.0 / 255, NULL, NULL, NULL};
}

void weft_photographs_free(weft_photograph_set *set)
{
    for (int i = 0; i < set->count; i++) {
        free(set->photograph[i].name);
        weft_image_free(&set->photograph[i].thumbnail);
        weft_image_free(&set->photograph[i].rectified);
    }
    free(set->photograph);
    free(set->pair);
    weft_lines_free(&set->notes);
    *set = (weft_photograph_set){0};
}

/* ---- Looking at all photographs ---- */

/* What is done with one photograph: fills it from its pixels. */
typedef weft_code (*look)(work *w, int index, const weft_light_values *values, weft_error *error);

static char *path_of(const char *folder, const char *name)
{
    char *path = NULL;
    return asprintf(&path, "%s/%s", folder, name) < 0 ? NULL : path;
}

static weft_code look_at(work *w, int index, look what, weft_error *error)
{
    weft_photographs_photograph *p = &w->set->photograph[index];
    weft_light_values values;
    char *path = path_of(w->folder, p->name);
    if (!path)
        return weft_fail_memory(error, p->name, strlen(p->name));
    weft_error own = {0};
    weft_file_range range = weft_file_range_of(&p->exif, w->settings->clipped_at);
    weft_code code = weft_light_values_read(path, p->exif.width, p->exif.height, &w->set->tone, range, &values, &own);
    free(path);
    if (weft_class_of(code) == WEFT_BAD_INPUT) {
        snprintf(p->remark, sizeof p->remark, "%.180s", own.message);
        return WEFT_OK;
    }
    if (code != WEFT_OK) {
        *error = own;
        return code;
    }
    code = what(w, index, &values, error);
    weft_light_values_free(&values);
    return code;
}

/* Looks at every photograph that is used still. */
static weft_code look_at_all(work *w, const char *doing, look what, weft_error *error)
{
    weft_code result = WEFT_OK;
    long done = 0;
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < w->set->count; i++) {
        weft_error own = {0};
        weft_code code = weft_photographs_used(&w->set->photograph[i]) ? look_at(w, i, what, &own) : WEFT_OK;
#pragma omp critical(weft_photographs_look)
        {
            weft_progress_report(w->progress, doing, ++done, w->set->count);
            if (code != WEFT_OK && result == WEFT_OK) {
                result = code;
                *error = own;
            }
        }
    }
    return result;
}

static weft_code look_for_corners(work *w, int index, const weft_light_values *values, weft_error *error)
{
    WEFT_TRY(weft_thumbnail_of_photograph(values, &w->set->photograph[index].thumbnail, error));
    return weft_corners_find(&w->settings->target, values, &w->set->photograph[index], error);
}

/* Pixels per mm in the middle of the plate: the median photograph decides how finely the target is drawn. */
static double typical_scale(const weft_photograph_set *set)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < set->count; i++) {
        const weft_photographs_photograph *p = &set->photograph[i];
        if (!weft_photographs_used(p))
            continue;
        sum += set->lens.camera.fx / p->pose.translation.z;
        count++;
    }
    return count ? sum / count : 0;
}

static weft_code look_for_light(work *w, int index, const weft_light_values *values, weft_error *error)
{
    weft_photographs_photograph *p = &w->set->photograph[index];
    weft_lamp_evidence *evidence = &w->evidence[index];
    const weft_camera *camera = &w->set->lens.camera;
    WEFT_TRY(weft_photographs_pose_refine(&w->sight, camera, values, p, error));
    if (!weft_photographs_used(p))
        return WEFT_OK;
    evidence->pose = p->pose;
    evidence->exposure = weft_exif_exposure(&p->exif);
    const weft_plate_view view = weft_plate_view_of(camera, &p->homography, &w->set->lens.bend);
    WEFT_TRY(weft_paper_sample_all(&w->places, camera, &view, values, &evidence->paper, error));
    for (int ball = 0; ball < WEFT_TARGET_BALL_COUNT && w->settings->ball_diameter_mm > 0; ball++) {
        double place[2];
        weft_target_ball(&w->settings->target, ball, place);
        double height = weft_bend_height(&w->set->lens.bend, place[0], place[1]);
        evidence->highlight[ball] = weft_ball_highlight(
            camera, &p->pose, values, weft_vec3_of(place[0], place[1], height), w->settings->ball_diameter_mm);
    }
    if (w->settings->lights)
        evidence->listed = weft_listed_lamp_of(w->settings->lights, p);
    if (w->pin_patch)
        return weft_pin_patch(&w->pin_area, camera, &view, values, &w->pin_patch[index], error);
    return WEFT_OK;
}

static int count_used(const weft_photograph_set *set)
{
    int used = 0;
    for (int i = 0; i < set->count; i++)
        used += weft_photographs_used(&set->photograph[i]);
    return used;
}

/* `missing`: what photographs must do; `advice`: how they come to do it. */
static weft_code check_enough(const work *w, const char *missing, const char *advice, weft_error *error)
{
    int used = count_used(w->set), first = 0;
    if (used >= WEFT_PHOTOGRAPHS_FEWEST)
        return WEFT_OK;
    while (first < w->set->count - 1 && weft_photographs_used(&w->set->photograph[first]))
        first++;
    return weft_fail(error, WEFT_BAD_INPUT, "'%s': %d of %d photographs %s, %d are needed; '%s': %s; %s", w->folder,
                     used, w->set->count, missing, WEFT_PHOTOGRAPHS_FEWEST, w->set->photograph[first].name,
                     w->set->photograph[first].remark, advice);
}

/* ---- The lamps ---- */

/* Photographs that show too little paper have no lamp. */
static void leave_out_paperless(work *w)
{
    const int fewest_samples = 40;
    for (int i = 0; i < w->set->count; i++) {
        weft_photographs_photograph *p = &w->set->photograph[i];
        if (weft_photographs_used(p) && w->evidence[i].paper.count < fewest_samples)
            weft_photographs_say_paperless(&w->evidence[i].paper, p);
    }
}

/* Levels follow the curve, which ends at 1. */
static void correct_tone(weft_photograph_set *set)
{
    double full = weft_tone_bend(&set->tone, set->lamps.tone);
    for (int i = 0; i < set->count; i++) {
        for (int c = 0; c < 3; c++)
            set->photograph[i].lamp.level[c] /= full;
    }
}

/* A pin is looked for unless the lamp shines from the camera: then it hides its own shadow. */
static weft_code prepare_pin(work *w, weft_error *error)
{
    if (!(w->settings->pin_height_mm > 2 * weft_pin_head_radius_mm) || w->settings->flash)
        return WEFT_OK;
    w->pin_area = weft_pin_area_of(&w->settings->target, w->settings->pin_height_mm);
    w->pin_patch = calloc((size_t)w->set->count, sizeof *w->pin_patch);
    return w->pin_patch ? WEFT_OK : weft_fail_memory(error, "shadows", (size_t)w->set->count * sizeof *w->pin_patch);
}

static void free_pin(work *w)
{
    for (int i = 0; w->pin_patch && i < w->set->count; i++)
        free(w->pin_patch[i]);
    free(w->pin_patch);
    w->pin_patch = NULL;
}

static weft_code find_pin(work *w, weft_error *error)
{
    size_t count = (size_t)w->set->count;
    weft_vec3 *eye = malloc(count * sizeof *eye);
    weft_pin_shadow *shadow = malloc(count * sizeof *shadow);
    weft_code code = WEFT_OK;
    if (!eye || !shadow)
        code = weft_fail_memory(error, "shadows", count * sizeof *shadow);
    for (size_t i = 0; code == WEFT_OK && i < count; i++)
        eye[i] = weft_pose_camera_position(&w->set->photograph[i].pose);
    if (code == WEFT_OK)
        code = weft_pin_find(&w->pin_area, &w->settings->target, eye, w->pin_patch, w->set->count, shadow, error);
    for (size_t i = 0; code == WEFT_OK && i < count; i++)
        w->evidence[i].pin = shadow[i];
    free(eye);
    free(shadow);
    return code;
}

/* The evidence of the photographs that are used, packed; the caller frees it. index [used_count] of each. */
static weft_code pack_evidence(const work *w, int used, weft_lamp_evidence **evidence, int **index, weft_error *error)
{
    int next = 0;
    *evidence = malloc((size_t)used * sizeof **evidence);
    *index = calloc((size_t)used, sizeof **index);
    if (!*evidence || !*index)
        return weft_fail_memory(error, "lamps", (size_t)used * sizeof **evidence);
    for (int i = 0; i < w->set->count; i++) {
        if (!weft_photographs_used(&w->set->photograph[i]))
            continue;
        (*index)[next] = i;
        (*evidence)[next++] = w->evidence[i];
    }
    return WEFT_OK;
}

/* set->pair: by their place among those that are used. */
static weft_code find_pairs(weft_lamp_problem *problem, weft_photograph_set *set, weft_error *error)
{
    set->pair = malloc((size_t)problem->count * sizeof *set->pair);
    if (!set->pair)
        return weft_fail_memory(error, "exposures", (size_t)problem->count * sizeof *set->pair);
    WEFT_TRY(weft_exposure_pairs_find(problem, set->pair, &set->pair_count, error));
    problem->pair = set->pair;
    problem->pair_count = set->pair_count;
    return WEFT_OK;
}

/* set->lamps.place and set->pair, by their place among those that are used. */
static weft_code solve_lamps(const work *w, const weft_lamp_evidence *evidence, int used, weft_error *error)
{
    weft_photograph_set *set = w->set;
    weft_lamp_problem problem = {.target = &w->settings->target,
                                 .places = &w->places,
                                 .count = used,
                                 .evidence = evidence,
                                 .ball_diameter_mm = w->settings->ball_diameter_mm,
                                 .pin_height_mm = w->settings->pin_height_mm,
                                 .corner_radius_squared = weft_lens_corner_radius_squared(&set->lens.camera),
                                 .bend = set->lens.bend,
                                 .flash = w->settings->flash,
                                 .tone_unknown = set->tone_found};
    if (set->tone_found)
        WEFT_TRY(find_pairs(&problem, set, error));
    weft_lamp_guess(&problem, &set->lamps);
    if (problem.pair_count > 0)
        WEFT_TRY(weft_tone_of_pairs(&problem, set->lamps.tone, error));
    return weft_lamp_solve(&problem, &set->lamps, error);
}

/* What is assumed of the lens makes views err, and lamps with them that balls show. */
static weft_code state_errors(weft_photograph_set *set, weft_error *error)
{
    for (int i = 0; i < set->count; i++) {
        weft_photographs_photograph *p = &set->photograph[i];
        double assumed;
        if (!weft_photographs_used(p))
            continue;
        WEFT_TRY(weft_lens_assumed_error(&set->lens, p, &assumed, error));
        p->view_uncertainty_deg = hypot(weft_photographs_view_error_deg(&set->lens.camera, p), assumed);
        if (p->lamp.source == WEFT_LAMP_BALLS || p->lamp.source == WEFT_LAMP_FLASH)
            p->lamp.uncertainty_deg = hypot(p->lamp.uncertainty_deg, assumed);
        set->lens.assumed_error_deg = fmax(set->lens.assumed_error_deg, assumed);
    }
    return WEFT_OK;
}

static weft_code find_lamps(work *w, weft_error *error)
{
    weft_photograph_set *set = w->set;
    int used = count_used(set), *index = NULL;
    weft_lamp_evidence *evidence = NULL;
    weft_code code = pack_evidence(w, used, &evidence, &index, error);
    if (code == WEFT_OK && !(set->lamps.place = calloc((size_t)used, sizeof *set->lamps.place)))
        code = weft_fail_memory(error, "lamps", (size_t)used * sizeof *set->lamps.place);
    if (code == WEFT_OK)
        code = solve_lamps(w, evidence, used, error);
    for (int i = 0; code == WEFT_OK && i < used; i++)
        set->photograph[index[i]].lamp = set->lamps.place[i];
    for (int i = 0; code == WEFT_OK && i < set->pair_count; i++) {
        set->pair[i].bright = index[set->pair[i].bright];
        set->pair[i].dark = index[set->pair[i].dark];
    }
    free(set->lamps.place);
    set->lamps.place = NULL;
    free(evidence);
    free(index);
    WEFT_TRY(code);
    WEFT_TRY(state_errors(set, error));
    memcpy(set->lens.camera.vignetting, set->lamps.vignetting, sizeof set->lamps.vignetting);
    if (set->tone_found)
        correct_tone(set);
    return WEFT_OK;
}

/* Photographs so dark that their noise would be most of what they say. */
static void leave_out_underexposed(weft_photograph_set *set)
{
    const double darkest_paper = 0.01;
    for (int i = 0; i < set->count; i++) {
        weft_photographs_photograph *p = &set->photograph[i];
        double paper = p->lamp.level[1] * weft_unit(p->lamp.position_mm).z;
        if (weft_photographs_used(p) && !(paper >= darkest_paper))
            snprintf(p->remark, sizeof p->remark, "it is underexposed: white paper reaches %.1f %% of full scale",
                     100 * paper);
    }
}

static weft_code refine_and_sample(work *w, weft_error *error)
{
    WEFT_TRY(
        weft_reduced_sight_create(&w->set->lens.camera, &w->settings->target, typical_scale(w->set), &w->sight, error));
    w->sight.sight.bend = w->set->lens.bend;
    weft_code code = look_at_all(w, "finding poses and lamps", look_for_light, error);
    weft_reduced_sight_free(&w->sight);
    return code;
}

static weft_code run(work *w, const char *output, weft_error *error)
{
    weft_photograph_set *set = w->set;
    WEFT_TRY(weft_photographs_list(w->folder, set, error));
    if (!(w->evidence = calloc((size_t)set->count, sizeof *w->evidence)))
        return weft_fail_memory(error, "evidence", (size_t)set->count * sizeof *w->evidence);
    WEFT_TRY(check_enough(w, "can be read", "copy the files as the camera wrote them", error));
    if (w->settings->lights)
        WEFT_TRY(weft_listed_check(w->settings->lights, set->photograph, set->count, error));
    const weft_exif *common = weft_photographs_common_size(set);
    WEFT_TRY(weft_photographs_check_sizes(w->folder, w->settings, common, set, error));
    weft_photographs_leave_out_other_lenses(set);
    set->tone_found = !w->settings->linear && !common->is_linear;
    set->tone = set->tone_found ? weft_tone_srgb() : weft_tone_linear();
    WEFT_TRY(look_at_all(w, "looking for the target", look_for_corners, error));
    WEFT_TRY(check_enough(w, "show the target", "photograph the whole sheet that weft target prints, sharp and bright",
                          error));
    WEFT_TRY(weft_lens_estimate_from(set->photograph, set->count, common->width, common->height, w->settings->lens,
                                     &set->lens, error));
    WEFT_TRY(weft_paper_places_create(&w->settings->target, &w->places, error));
    WEFT_TRY(prepare_pin(w, error));
    WEFT_TRY(refine_and_sample(w, error));
    if (w->pin_patch)
        WEFT_TRY(find_pin(w, error));
    free_pin(w);
    leave_out_paperless(w);
    WEFT_TRY(check_enough(w, "can be used", what_helps, error));
    WEFT_TRY(find_lamps(w, error));
    leave_out_underexposed(set);
    weft_photographs_leave_out_unlit(set);
    weft_photographs_leave_out_darker(set);
    WEFT_TRY(weft_photographs_check_light(w->folder, w->settings, set, error));
    WEFT_TRY(weft_photographs_check_flash(w->folder, w->settings, set, error));
    WEFT_TRY(weft_photographs_note(&w->settings->target, set, error));
    if (!w->settings->colour)
        WEFT_TRY(weft_photographs_note_colours(set, error));
    if (w->settings->lights)
        WEFT_TRY(weft_listed_compare(w->settings->lights, set->photograph, set->count, &set->notes, error));
    WEFT_TRY(check_enough(w, "can be used", what_helps, error));
    WEFT_TRY(weft_photographs_check_variety(w->folder, set, error));
    return weft_photographs_write_dataset(w->folder, output, w->settings, w->progress, set, error);
}

weft_code weft_photographs_register(const char *folder, const char *output, const weft_photographs_settings *settings,
                                    const weft_progress *progress, weft_photograph_set *set, weft_error *error)
{
    work w = {.folder = folder, .settings = settings, .progress = progress, .set = set};
    double began_s = weft_now_s();
    *set = (weft_photograph_set){0};
    weft_code code = run(&w, output, error);
    for (int i = 0; w.evidence && i < set->count; i++)
        free(w.evidence[i].paper.sample);
    free(w.evidence);
    free_pin(&w);
    weft_paper_places_free(&w.places);
    set->used_count = count_used(set);
    set->seconds = weft_now_s() - began_s;
    if (code != WEFT_OK)
        weft_photographs_free(set);
    return code;
}
