#include "btf/material/held_out.h"

#include "base/text/json_text.h"
#include "btf/direction/direction.h"
#include "btf/material/metadata.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- To JSON ---- */

/* In the order of weft_split_kind. */
static const char *const kind_names[] = {"directions", "photographs", "each photograph"};

static json_t *json_of_error(const weft_error_summary *e)
{
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:I}", "relative_rmse", e->relative_rmse, "median_relative_error",
                     e->median_relative, "percentile80_relative_error", e->percentile80_relative, "rmse", e->rmse,
                     "psnr_db", isfinite(e->psnr_db) ? e->psnr_db : 0, "values", (json_int_t)e->count);
}

static void put_error(json_t **object, const char *name, const weft_error_summary *e)
{
    if (e->count > 0)
        weft_json_put(object, name, json_of_error(e));
}

static json_t *json_of_errors(const weft_hold_out_error *error)
{
    json_t *object = json_of_error(&error->all);
    put_error(&object, "views", &error->view);
    put_error(&object, "lights", &error->light);
    put_error(&object, "both", &error->both);
    return object;
}

json_t *weft_hold_out_to_json(const weft_hold_out *r)
{
    json_t *object = json_pack("{s:s, s:i, s:[ii], s:[II]}", "held_out", kind_names[r->kind], "splits", r->split_count,
                               "images_of", r->image_held_count, r->image_count, "texels_of",
                               (json_int_t)r->texel_count, (json_int_t)r->dataset_texel_count);
    if (r->kind == WEFT_SPLIT_DIRECTIONS) {
        weft_json_put(&object, "views_of", json_pack("[ii]", r->view_held_count, r->view_count));
        weft_json_put(&object, "lights_of", json_pack("[ii]", r->light_held_count, r->light_count));
    }
    if (r->smaller_model)
        weft_json_put(&object, "smaller_model", json_true());
    if (r->heights.asked)
        weft_json_put(&object, "heights",
                      json_pack("{s:b, s:f, s:f}", "used", r->heights.used, "relative_rmse_with", r->heights.with,
                                "relative_rmse_without", r->heights.without));
    weft_json_put(&object, "not_fitted", json_of_errors(&r->material));
    weft_json_put(&object, "photographs_interpolated", json_of_errors(&r->photographs));
    if (r->photographs_flat > 0)
        weft_json_put(&object, "photographs_without_heights", json_real(r->photographs_flat));
    weft_json_put(&object, "fitted", json_of_error(&r->fitted));
    return object;
}

weft_code weft_hold_out_store(const weft_hold_out *result, weft_material *material, weft_error *error)
{
    WEFT_TRY(weft_material_put_metadata(material, "held_out", weft_hold_out_to_json(result), error));
    if (!result->has_certificate)
        return WEFT_OK;
    return weft_material_put_metadata(material, "certificate", weft_certificate_pack(&result->certificate), error);
}

/* ---- From JSON ---- */

static bool read_error(const json_t *object, weft_error_summary *e)
{
    json_int_t count = 0;
    *e = (weft_error_summary){0};
    if (!object)
        return true;
    bool complete =
        json_unpack((json_t *)object, "{s:F, s:F, s:F, s:F, s:F, s:I}", "relative_rmse", &e->relative_rmse,
                    "median_relative_error", &e->median_relative, "percentile80_relative_error",
                    &e->percentile80_relative, "rmse", &e->rmse, "psnr_db", &e->psnr_db, "values", &count) == 0;
    e->count = (long)count;
    return complete;
}

static bool read_errors(const json_t *object, weft_hold_out_error *error)
{
    return object && read_error(object, &error->all) && read_error(json_object_get(object, "views"), &error->view) &&
           read_error(json_object_get(object, "lights"), &error->light) &&
           read_error(json_object_get(object, "both"), &error->both);
}

static bool read_kind(const char *name, weft_split_kind *kind)
{
    for (size_t i = 0; name && i < sizeof kind_names / sizeof *kind_names; i++) {
        *kind = (weft_split_kind)i;
        if (strcmp(name, kind_names[i]) == 0)
            return true;
    }
    return false;
}

static bool read_heights(const json_t *object, weft_hold_out_heights *heights)
{
    int used = 0;
    heights->asked = object != NULL;
    bool complete = !object || json_unpack((json_t *)object, "{s:b, s:F, s:F}", "used", &used, "relative_rmse_with",
                                           &heights->with, "relative_rmse_without", &heights->without) == 0;
    heights->used = used;
    return complete;
}

static bool read_object(const json_t *object, weft_hold_out *r)
{
    const char *kind = NULL;
    json_int_t texels = 0, all_texels = 0;
    int smaller = 0;
    *r = (weft_hold_out){0};
    bool complete = object && json_unpack((json_t *)object, "{s:s, s:i, s:[ii], s:[II], s?b, s?[ii], s?[ii]}",
                                          "held_out", &kind, "splits", &r->split_count, "images_of",
                                          &r->image_held_count, &r->image_count, "texels_of", &texels, &all_texels,
                                          "smaller_model", &smaller, "views_of", &r->view_held_count, &r->view_count,
                                          "lights_of", &r->light_held_count, &r->light_count) == 0;
    r->texel_count = (long)texels;
    r->dataset_texel_count = (long)all_texels;
    r->smaller_model = smaller;
    r->photographs_flat = json_number_value(json_object_get(object, "photographs_without_heights"));
    return complete && read_kind(kind, &r->kind) && read_heights(json_object_get(object, "heights"), &r->heights) &&
           read_errors(json_object_get(object, "not_fitted"), &r->material) &&
           read_errors(json_object_get(object, "photographs_interpolated"), &r->photographs) &&
           read_error(json_object_get(object, "fitted"), &r->fitted);
}

weft_code weft_hold_out_read(const char *metadata, bool *found, weft_hold_out *result, weft_error *error)
{
    errno = 0;
    json_t *object = json_loads(metadata, 0, NULL), *own = json_object_get(object, "held_out");
    bool is_short = !object && errno == ENOMEM;
    errno = 0; /* jansson allocates to unpack, too */
    *found = own && read_object(own, result);
    is_short = is_short || (own && !*found && errno == ENOMEM);
    json_decref(object);
    if (*found)
        return weft_certificate_read(metadata, &result->has_certificate, &result->certificate, error);
    return is_short ? weft_fail_memory(error, "metadata of the material", strlen(metadata)) : WEFT_OK;
}

/* ---- In words ---- */

const char *weft_hold_out_about(const weft_hold_out *result)
{
    return result->kind == WEFT_SPLIT_DIRECTIONS ? "on directions that were not fitted"
                                                 : "on photographs that were not fitted";
}

void weft_hold_out_headline(const weft_hold_out *r, char line[WEFT_HOLD_OUT_LINE])
{
    char photographs[128] = "";
    if (r->photographs.all.count > 0 && r->photographs_flat > 0)
        snprintf(photographs, sizeof photographs,
                 " (the photographs themselves, interpolated through their heights: %.1f %%, without them: %.1f %%)",
                 100 * r->photographs.all.relative_rmse, 100 * r->photographs_flat);
    else if (r->photographs.all.count > 0)
        snprintf(photographs, sizeof photographs, " (the photographs themselves, interpolated: %.1f %%)",
                 100 * r->photographs.all.relative_rmse);
    snprintf(line, WEFT_HOLD_OUT_LINE, "%s: relative RMSE %.1f %%%s; on those that were: %.1f %%",
             weft_hold_out_about(r), 100 * r->material.all.relative_rmse, photographs, 100 * r->fitted.relative_rmse);
}

/* Appends to a line; what does not fit is cut. */
#define APPEND(line, ...) snprintf((line) + strlen(line), WEFT_HOLD_OUT_LINE - strlen(line), __VA_ARGS__)

static void explain_directions(const weft_hold_out *r, char line[WEFT_HOLD_OUT_LINE])
{
    const char *joint = "";
    if (r->view_held_count > 0) {
        APPEND(line, "%d of %d views", r->view_held_count, r->view_count);
        joint = " and ";
    }
    if (r->light_held_count > 0)
        APPEND(line, "%s%d of %d lights", joint, r->light_held_count, r->light_count);
    APPEND(line, " left out");
    if (r->material.view.count > 0)
        APPEND(line, ", relative RMSE of the views %.1f %%", 100 * r->material.view.relative_rmse);
    if (r->material.light.count > 0)
        APPEND(line, ", of the lights %.1f %%", 100 * r->material.light.relative_rmse);
    if (r->material.both.count > 0)
        APPEND(line, ", of both %.1f %%", 100 * r->material.both.relative_rmse);
}

void weft_certificate_describe(const weft_certificate *c, char line[WEFT_HOLD_OUT_LINE])
{
    line[0] = 0;
    APPEND(line, "%g %% of the pixels of ", 100 * c->probability);
    if (!c->over_images)
        APPEND(line, "images like the %d that were held out: too few to say so of others (it takes 19)",
               c->image_count);
    else
        APPEND(line, "images not seen, as of the %d that were held out%s", c->image_count,
               c->image_count == c->direction_count ? "" : " with their views and lights");
}

void weft_certificate_describe_levels(const weft_certificate *c, char line[WEFT_HOLD_OUT_LINE])
{
    int last = c->measured_levels - 1;
    line[0] = 0;
    if (c->measured_levels == 0)
        return;
    if (last > 0)
        APPEND(line, "measured on levels 0 to %d", last);
    else
        APPEND(line, "measured on level 0");
    if (c->measured_levels < c->level_count && last > 0)
        APPEND(line,
               ": no larger squares than of %d x %d texels are measured, and coarser levels have the width of smaller "
               "ones, which is rather too wide",
               1 << last, 1 << last);
    else if (c->measured_levels < c->level_count)
        APPEND(line,
               " alone, on single texels; coarser levels have the width of fewer texels, which is rather too wide");
}

void weft_certificate_row(const weft_certificate *c, int ring, char line[WEFT_HOLD_OUT_LINE])
{
    const weft_vec3 light = weft_direction_of_angles((weft_angles){weft_rad_of_deg(30), 0}),
                    view = weft_direction_of_angles((weft_angles){weft_rad_of_deg(15 * ring), 0});
    double half_width = weft_certificate_half_width(c, 0, c->mean, light, view);
    weft_certificate_parts parts = weft_certificate_parts_of(c, 0, ring);
    line[0] = 0;
    APPEND(line, "+-%.3g (%.0f %%): sampling %.0f %%, model %.0f %%, storage %.1f %%, ", half_width,
           100 * half_width / c->mean, 100 * parts.sampling, 100 * parts.model, 100 * parts.storage);
    if (c->has_registration)
        APPEND(line, "registration %.1f %%", 100 * parts.registration);
    else
        APPEND(line, "registration not known");
    if (c->view_images[ring] == 0)
        APPEND(line, "; as of the nearest ring with images held out");
}

void weft_hold_out_explain(const weft_hold_out *r, char line[WEFT_HOLD_OUT_LINE])
{
    line[0] = 0;
    APPEND(line, "measured with ");
    if (r->kind == WEFT_SPLIT_DIRECTIONS)
        explain_directions(r, line);
    else if (r->kind == WEFT_SPLIT_PHOTOGRAPHS)
        APPEND(line, "%d of %d photographs left out", r->image_held_count, r->image_count);
    else
        APPEND(line, "each of %d photographs left out in turn", r->image_count);
    APPEND(line, "; median relative error %.1f %%", 100 * r->material.all.median_relative);
    if (r->kind != WEFT_SPLIT_EACH && r->split_count > 1)
        APPEND(line, "; mean of %d such fits", r->split_count);
    if (r->texel_count < r->dataset_texel_count)
        APPEND(line, "; on %ld of %ld texels", r->texel_count, r->dataset_texel_count);
    if (r->heights.asked)
        APPEND(line, "; through the heights %.1f %%, without them %.1f %%%s", 100 * r->heights.with,
               100 * r->heights.without, r->heights.used ? "" : ": they are left out");
    if (r->smaller_model)
        APPEND(line, "; too few were left for the whole model");
}
