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
enum { FEWEST_VIEWS_OF_BARD = 10, FEWEST_COMPONENTS = 4 };

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

static void add_rti(model_list *list)
{
    for (weft_rti_model model = 0; model < WEFT_RTI_MODELS; model++) {
        if (!weft_rti_is_for(model, list->layout))
            continue;
        add_alone(list, WEFT_PRICED_RTI, weft_rti_name(model));
        list->model[list->count - 1].rti = model;
    }
}

static void add_factorised(model_list *list)
{
    if (!weft_factorised_is_for(list->layout))
        return;
    for (weft_factorised_kind kind = 0; kind < WEFT_FACTORISED_KINDS; kind++) {
        add_alone(list, WEFT_PRICED_FACTORISED, weft_factorised_name(kind));
        list->model[list->count - 1].factorised = kind;
    }
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
    add_rti(&list);
    add_factorised(&list);
    if (dataset->cloth)
        add_alone(&list, WEFT_PRICED_CLOTH, "analytic cloth");
    add_photographs(&list);
    return list.count;
}

const char *weft_priced_family_name(weft_priced_family family)
{
    static const char *const name[] = {"lobes",          "components", "fewer photographs", "photographs", "BARD",
                                       "analytic cloth", "RTI",        "matrices"};
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
           a->component_count == b->component_count && model->photographs == other->photographs;
}

/* ---- Fewer photographs ---- */

static bool is_of_rings(weft_vec3 direction, weft_photographs_taken every)
{
    return every == WEFT_PHOTOGRAPHS_ALL ||
           weft_ubo81_ring(weft_angles_of_direction(direction).theta_rad) % (int)every == 0;
}

int weft_photographs_leave_out(const weft_dataset_layout *layout, weft_photographs_taken taken, uint8_t *left_out)
{
    int x = layout->width / 2, y = layout->height / 2, count = 0;
    for (int i = 0; i < layout->image_count; i++) {
        weft_vec3 light = weft_dataset_light_direction(layout, i, x, y);
        weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[i], x, y);
        left_out[i] = !is_of_rings(light, taken) || !is_of_rings(view, taken);
        count += !left_out[i];
    }
    return count;
}
