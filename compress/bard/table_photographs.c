#include "compress/bard/texel_table.h"

#include "btf/direction/direction.h"

#include <stdlib.h>

/* Farther from the normal a light is not "the one along the normal": half the distance of two rings of ubo81. Rigs move
 * it aside by a few degrees where the camera stands in its way. */
static const double max_tilt_deg = 7.5;

/* Two views span no surface of directions. */
enum { MIN_VIEWS = 3 };

static double tilt_deg(weft_vec3 light)
{
    return weft_deg_of_rad(weft_angles_of_direction(light).theta_rad);
}

/* For each view the image lit from nearest the normal of those that are not left out, or -1. */
static void find_highest_lights(const weft_dataset_layout *layout, const uint8_t *left_out, int *highest)
{
    for (int view = 0; view < layout->view_count; view++)
        highest[view] = -1;
    for (int i = 0; i < layout->image_count; i++) {
        int *of_view = &highest[layout->view_of_image[i]];
        if (left_out && left_out[i])
            continue;
        if (*of_view < 0 || layout->light[i].z > layout->light[*of_view].z)
            *of_view = i;
    }
}

/* Keeps those whose light is near enough and whose view is above the horizon. */
static void choose_photographs(const weft_dataset_layout *layout, const int *highest, weft_bard_plan *plan)
{
    for (int view = 0; view < layout->view_count; view++) {
        int image = highest[view];
        double tilt = image < 0 ? INFINITY : tilt_deg(layout->light[image]);
        plan->least_tilt_deg = fmin(plan->least_tilt_deg, tilt);
        if (!(tilt <= max_tilt_deg) || !(layout->view[view].z > 0))
            continue;
        plan->largest_tilt_deg = fmax(plan->largest_tilt_deg, tilt);
        plan->photograph[plan->count] = image;
        plan->view[plan->count++] = layout->view[view];
        plan->is_used[image] = true;
    }
}

static weft_code find_photographs(const weft_dataset_layout *layout, const uint8_t *left_out, weft_bard_plan *plan,
                                  weft_error *error)
{
    int *highest = calloc((size_t)layout->view_count, sizeof *highest);
    if (!highest)
        return weft_fail_memory(error, "views", (size_t)layout->view_count * sizeof *highest);
    plan->least_tilt_deg = INFINITY;
    find_highest_lights(layout, left_out, highest);
    choose_photographs(layout, highest, plan);
    free(highest);
    return WEFT_OK;
}

static weft_code check_photographs(const weft_bard_plan *plan, const char *path, weft_error *error)
{
    if (plan->least_tilt_deg > max_tilt_deg)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': the light nearest the normal is %.1f degrees from it; BARD needs one within %g", path,
                         plan->least_tilt_deg, max_tilt_deg);
    if (plan->count < MIN_VIEWS)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': only %d views were photographed under the light along the normal; BARD needs %d", path,
                         plan->count, (int)MIN_VIEWS);
    return WEFT_OK;
}

static weft_code allocate(const weft_dataset_layout *layout, weft_bard_plan *plan, weft_error *error)
{
    size_t images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    plan->photograph = calloc(views, sizeof *plan->photograph);
    plan->view = calloc(views, sizeof *plan->view);
    plan->is_used = calloc(images, sizeof *plan->is_used);
    plan->mix = calloc(images, sizeof *plan->mix);
    if (!plan->photograph || !plan->view || !plan->is_used || !plan->mix)
        return weft_fail_memory(error, "photographs", images * sizeof *plan->mix + views * sizeof *plan->view);
    return WEFT_OK;
}

static weft_code mix_images(const weft_dataset_layout *layout, weft_bard_map map, weft_bard_plan *plan,
                            weft_error *error)
{
    weft_triangulation *views;
    WEFT_TRY(weft_triangulation_build(plan->view, plan->count, &views, error));
    for (int i = 0; i < layout->image_count; i++)
        plan->mix[i] = weft_bard_mix_views(map, views, layout->light[i], layout->view[layout->view_of_image[i]]);
    for (int k = 0; k < plan->count; k++)
        plan->mix[plan->photograph[k]] = (weft_bard_mix){1, {{k, -1, -1}, {1, 0, 0}}};
    weft_triangulation_free(views);
    return WEFT_OK;
}

static weft_code make(const weft_dataset_layout *layout, const uint8_t *left_out, const char *path, weft_bard_map map,
                      weft_bard_plan *plan, weft_error *error)
{
    if (layout->distance == WEFT_NEAR)
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s' has near lights and cameras; BARD maps directions, which differ from texel to texel there", path);
    WEFT_TRY(allocate(layout, plan, error));
    WEFT_TRY(find_photographs(layout, left_out, plan, error));
    WEFT_TRY(check_photographs(plan, path, error));
    return mix_images(layout, map, plan, error);
}

weft_code weft_bard_plan_create(const weft_dataset_layout *layout, const uint8_t *left_out, const char *path,
                                weft_bard_map map, weft_bard_plan *plan, weft_error *error)
{
    *plan = (weft_bard_plan){0};
    weft_code code = make(layout, left_out, path, map, plan, error);
    if (code != WEFT_OK)
        weft_bard_plan_free(plan);
    return code;
}

void weft_bard_plan_free(weft_bard_plan *plan)
{
    free(plan->photograph);
    free(plan->view);
    free(plan->is_used);
    free(plan->mix);
    *plan = (weft_bard_plan){0};
}
