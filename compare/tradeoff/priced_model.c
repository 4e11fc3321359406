#include "compare/tradeoff/priced_model.h"

#include "btf/direction/direction.h"
#include "compress/bard/predict.h"
#include "compress/compress.h"
#include "compress/hold_out/hold_out.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* BARD is offered where so many views were photographed under the light along the normal: then none of these lights is
 * held out (compress/hold_out/split.h). */
enum { FEWEST_VIEWS_OF_BARD = 10, FEWEST_COMPONENTS = 4, MAPS_COMPARED = 16 };

/* Of the images this share at least is left where a tenth of the views and a tenth of the lights are held out. */
static const double least_share = 0.8;

/* ---- The list ---- */

typedef struct model_list {
    const weft_dataset_layout *layout;
    const weft_priced_dataset *dataset;
    weft_priced_model *model;
    int count;
} model_list;

/* Whether weft compress makes of the options what they ask for, also without the images that are held out. */
static bool is_carried(const weft_dataset_layout *layout, const weft_compress_options *options)
{
    weft_dataset_layout left = *layout;
    left.image_count = (int)(least_share * layout->image_count);
    int lobes;
    weft_compress_plan(&left, options, &lobes);
    return options->component_count > 0 || lobes == options->lobe_count;
}

static weft_priced_model *add(model_list *list, weft_priced_family family, const weft_compress_options *options,
                              int work, const char *name, const char *arguments)
{
    if (!is_carried(list->layout, options) || list->count == WEFT_PRICED_MOST)
        return NULL;
    weft_priced_model *model = &list->model[list->count++];
    *model = (weft_priced_model){.family = family, .options = *options, .work = work};
    snprintf(model->name, sizeof model->name, "%s", name);
    snprintf(model->arguments, sizeof model->arguments, "%s", arguments);
    return model;
}

static weft_compress_options lobes_alone(int lobes)
{
    weft_compress_options options = weft_compress_default_options();
    options.lobe_count = lobes;
    options.component_count = 0;
    options.heights = false;
    return options;
}

static void add_lobes(model_list *list)
{
    for (int lobes = 1; lobes <= WEFT_MATERIAL_MAX_LOBES; lobes++) {
        weft_compress_options options = lobes_alone(lobes);
        char name[WEFT_PRICED_NAME], arguments[WEFT_PRICED_ARGUMENTS];
        snprintf(name, sizeof name, "%d lobe%s", lobes, lobes > 1 ? "s" : "");
        snprintf(arguments, sizeof arguments, "--lobes %d", lobes);
        add(list, WEFT_PRICED_LOBES, &options, 2 + lobes, name, arguments);
    }
}

static weft_compress_options components_alone(const model_list *list, int components)
{
    weft_compress_options options = weft_compress_default_options();
    options.component_count = components;
    options.heights = list->dataset->has_surface;
    return options;
}

static void add_components_seen(model_list *list, const weft_compress_options *options, const char *seen)
{
    char name[WEFT_PRICED_NAME], arguments[WEFT_PRICED_ARGUMENTS];
    snprintf(name, sizeof name, "%d components%s", options->component_count, seen);
    snprintf(arguments, sizeof arguments, "--components %d", options->component_count);
    add(list, WEFT_PRICED_COMPONENTS, options, 5, name, arguments);
}

/* The kinds of maps that components choose between, of a grid. */
static void add_kinds_of_maps(model_list *list, int components)
{
    static const char *const over[] = {"the light", "the half vector"};
    weft_compress_options options = components_alone(list, components);
    options.heights = false;
    for (int kind = 0; kind < 2 && !weft_images_are_scattered(list->layout, NULL); kind++) {
        char name[WEFT_PRICED_NAME];
        options.component_maps = kind == 0 ? WEFT_COMPONENT_MAPS_OF_LIGHT : WEFT_COMPONENT_MAPS_OF_HALF_VECTOR;
        snprintf(name, sizeof name, "%d components over %s", components, over[kind]);
        add(list, WEFT_PRICED_COMPONENTS, &options, 5, name, "");
    }
}

/* Where there are heights, without them and then through them. */
static void add_components(model_list *list)
{
    for (int components = FEWEST_COMPONENTS; components <= WEFT_COMPONENTS_MAX; components *= 2) {
        weft_compress_options options = components_alone(list, components), without = options;
        without.heights = false;
        if (list->dataset->has_surface)
            add_components_seen(list, &without, ", without heights");
        add_components_seen(list, &options, list->dataset->has_surface ? ", through heights" : "");
    }
    add_kinds_of_maps(list, MAPS_COMPARED);
}

static void add_subset(model_list *list, weft_photographs_taken taken, const char *what)
{
    const weft_compress_options options[2] = {lobes_alone(2), components_alone(list, 32)};
    for (int i = 0; i < 2; i++) {
        char name[WEFT_PRICED_NAME];
        snprintf(name, sizeof name, "%s, %s", i == 0 ? "2 lobes" : "32 components", what);
        weft_priced_model *model = add(list, WEFT_PRICED_FEWER, &options[i], 3, name, "");
        if (model)
            model->photographs = taken;
    }
}

/* Of a grid of views and lights as fine as ubo81. */
static void add_subsets(model_list *list)
{
    if (list->layout->view_count < 61 || list->layout->image_count < 41 * list->layout->view_count)
        return;
    add_subset(list, WEFT_PHOTOGRAPHS_SECOND_RINGS, "every second ring");
    add_subset(list, WEFT_PHOTOGRAPHS_THIRD_RINGS, "every third ring");
    add_subset(list, WEFT_PHOTOGRAPHS_41_VIEWS, "41 views");
    add_subset(list, WEFT_PHOTOGRAPHS_21_VIEWS, "21 views");
}

static void add_alone(model_list *list, weft_priced_family family, const char *name)
{
    weft_priced_model *model = &list->model[list->count++];
    *model = (weft_priced_model){.family = family, .cloth = list->dataset->cloth, .work = 1};
    snprintf(model->name, sizeof model->name, "%s", name);
}

static void add_bard(model_list *list)
{
    if (weft_bard_count_photographs(list->layout, NULL) >= FEWEST_VIEWS_OF_BARD)
        add_alone(list, WEFT_PRICED_BARD, "BARD from one light");
}

static void add_raw(model_list *list, bool through, const char *name)
{
    add_alone(list, WEFT_PRICED_RAW, name);
    list->model[list->count - 1].options.heights = through;
}

static void add_photographs(model_list *list)
{
    add_raw(list, false,
            list->dataset->has_surface ? "the photographs, without heights" : "the photographs, interpolated");
    if (list->dataset->has_surface)
        add_raw(list, true, "the photographs, through heights");
}

weft_priced_dataset weft_priced_dataset_of(const weft_dataset *dataset)
{
    return (weft_priced_dataset){weft_dataset_has_surface(dataset), NULL};
}

bool weft_priced_heights_are_kept(double without, double through)
{
    return through <= WEFT_HOLD_OUT_HEIGHTS_GAIN * without;
}

int weft_priced_models_list(const weft_dataset_layout *layout, const weft_priced_dataset *dataset,
                            weft_priced_model *model)
{
    model_list list = {.layout = layout, .dataset = dataset, .model = model};
    add_lobes(&list);
    add_components(&list);
    add_subsets(&list);
    add_bard(&list);
    if (dataset->cloth)
        add_alone(&list, WEFT_PRICED_CLOTH, "analytic cloth");
    add_photographs(&list);
    return list.count;
}

const char *weft_priced_family_name(weft_priced_family family)
{
    static const char *const name[] = {"lobes",       "components", "fewer photographs",
                                       "photographs", "BARD",       "analytic cloth"};
    return name[family];
}

bool weft_priced_model_is_fit(const weft_priced_model *model)
{
    return model->family < WEFT_PRICED_RAW;
}

bool weft_priced_model_is_of_lobes(const weft_priced_model *model)
{
    return weft_priced_model_is_fit(model) && model->options.component_count == 0;
}

bool weft_priced_models_share_fit(const weft_priced_model *model, const weft_priced_model *other)
{
    const weft_compress_options *a = &model->options, *b = &other->options;
    return weft_priced_model_is_fit(model) && weft_priced_model_is_fit(other) && a->lobe_count == b->lobe_count &&
           a->component_count == b->component_count && a->component_maps == b->component_maps &&
           model->photographs == other->photographs;
}

/* ---- Fewer photographs ---- */

static bool is_of_rings(weft_vec3 direction, int every)
{
    return weft_ubo81_ring(weft_angles_of_direction(direction).theta_rad) % every == 0;
}

static weft_vec3 view_at_centre(const weft_dataset_layout *layout, int view)
{
    return weft_dataset_view_direction(layout, view, layout->width / 2, layout->height / 2);
}

/* The view that is farthest from all that are taken; first the one nearest to the normal. */
static int farthest_view(const weft_dataset_layout *layout, const uint8_t *is_taken, int taken)
{
    int farthest = 0;
    weft_real least = 3;
    for (int view = 0; view < layout->view_count; view++) {
        weft_vec3 at = view_at_centre(layout, view);
        weft_real nearest = taken == 0 ? -at.z : -1;
        for (int other = 0; other < layout->view_count; other++) {
            if (is_taken[other])
                nearest = fmax(nearest, weft_dot(at, view_at_centre(layout, other)));
        }
        if (!is_taken[view] && nearest < least) {
            farthest = view;
            least = nearest;
        }
    }
    return farthest;
}

static weft_code take_views(const weft_dataset_layout *layout, int count, uint8_t *left_out, weft_error *error)
{
    uint8_t *is_taken = calloc((size_t)layout->view_count, 1);
    if (!is_taken)
        return weft_fail_memory(error, "views", (size_t)layout->view_count);
    for (int taken = 0; taken < count && taken < layout->view_count; taken++)
        is_taken[farthest_view(layout, is_taken, taken)] = 1;
    for (int i = 0; i < layout->image_count; i++)
        left_out[i] = !is_taken[layout->view_of_image[i]];
    free(is_taken);
    return WEFT_OK;
}

weft_code weft_photographs_leave_out(const weft_dataset_layout *layout, weft_photographs_taken taken, uint8_t *left_out,
                                     int *taken_count, weft_error *error)
{
    memset(left_out, 0, (size_t)layout->image_count);
    if (taken == WEFT_PHOTOGRAPHS_41_VIEWS || taken == WEFT_PHOTOGRAPHS_21_VIEWS)
        WEFT_TRY(take_views(layout, taken == WEFT_PHOTOGRAPHS_41_VIEWS ? 41 : 21, left_out, error));
    int x = layout->width / 2, y = layout->height / 2;
    int every = taken == WEFT_PHOTOGRAPHS_SECOND_RINGS ? 2 : taken == WEFT_PHOTOGRAPHS_THIRD_RINGS ? 3 : 0;
    *taken_count = 0;
    for (int i = 0; i < layout->image_count; i++) {
        if (every > 0)
            left_out[i] = !is_of_rings(weft_dataset_light_direction(layout, i, x, y), every) ||
                          !is_of_rings(view_at_centre(layout, layout->view_of_image[i]), every);
        *taken_count += !left_out[i];
    }
    return WEFT_OK;
}
