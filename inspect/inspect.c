#include "inspect/inspect.h"

#include "base/atomic_file.h"
#include "base/numeric/statistics.h"
#include "base/text/json_text.h"
#include "btf/dataset/dataset.h"
#include "btf/direction/direction.h"
#include "btf/file_kind.h"
#include "btf/material/held_out.h"
#include "btf/session/camera_list.h"
#include "geometry/yarn/tile_mesh.h"
#include "inspect/verify.h"
#include "reflectance/microcylinder/file.h"
#include "reflectance/weave/weave.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const size_t longest_list = 16;

/* Replaces long lists (of photographs, of views) by how long they are: they are data, not a description. False where
 * memory is short. */
static bool shorten_lists(json_t *object)
{
    const char *name;
    json_t *value;
    void *next;
    bool shortened = true;
    json_object_foreach_safe(object, next, name, value)
    {
        if (json_is_object(value))
            shortened = shorten_lists(value) && shortened;
        else if (json_array_size(value) > longest_list)
            shortened = json_object_set_new(object, name, json_sprintf("%zu entries", json_array_size(value))) == 0 &&
                        shortened;
    }
    return shortened;
}

/* A JSON text that came with a file, as an object; NULL where memory is short. */
static json_t *parsed(const char *text)
{
    errno = 0;
    json_t *value = json_loads(text, JSON_DECODE_ANY, NULL);
    if (!value)
        return errno == ENOMEM ? NULL : json_string("not JSON");
    if (shorten_lists(value))
        return value;
    json_decref(value);
    return NULL;
}

/* ---- Material ---- */

static json_t *describe_level(const weft_material *material, int k)
{
    const weft_material_level *level = &material->level[k];
    const weft_error_summary *e = &level->error;
    json_t *described = json_pack("{s:[ii]}", "texels", level->width, level->height);
    if (k > 0 && weft_material_has_components_alone(material))
        return described;
    weft_json_put(&described, "median_relative_error", json_real(e->median_relative));
    weft_json_put(&described, "percentile80_relative_error", json_real(e->percentile80_relative));
    weft_json_put(&described, "rmse", json_real(e->rmse));
    weft_json_put(&described, "relative_rmse", json_real(e->relative_rmse));
    weft_json_put(&described, "psnr_db", weft_json_number(e->psnr_db));
    if (material->components)
        weft_json_put(&described, "errors_of", json_string(weft_material_errors_of(material)));
    return described;
}

/* The error to judge a material by, then that on what it was fitted to. What says how it was measured is in the
 * metadata. */
static json_t *describe_error(const weft_material *material, const weft_hold_out *held_out)
{
    json_t *described = json_object();
    bool is_all = !material->components || weft_material_has_components_alone(material);
    const char *name = is_all                     ? "fitted_level_0"
                       : material->lobe_count > 0 ? "fitted_level_0_lobes"
                                                  : "fitted_level_0_diffuse_term";
    if (held_out) {
        char how[WEFT_HOLD_OUT_LINE];
        weft_hold_out_explain(held_out, how);
        weft_json_put(&described, "not_fitted", json_real(held_out->material.all.relative_rmse));
        weft_json_put(&described, "photographs_interpolated", json_real(held_out->photographs.all.relative_rmse));
        if (held_out->photographs_flat > 0)
            weft_json_put(&described, "photographs_without_heights", json_real(held_out->photographs_flat));
        weft_json_put(&described, "fitted", json_real(held_out->fitted.relative_rmse));
        weft_json_put(&described, "how", json_string(how));
    } else {
        weft_json_put(&described, "not_fitted", json_string("not measured"));
    }
    weft_json_put(&described, name, json_real(material->level[0].error.relative_rmse));
    return described;
}

/* Half the width of the interval of level 0 by ring of the view. */
static json_t *describe_certificate(const weft_certificate *certificate)
{
    char line[WEFT_HOLD_OUT_LINE], name[32];
    weft_certificate_describe(certificate, line);
    json_t *described = json_pack("{s:s, s:f}", "holds_for", line, "at_mean_value", certificate->mean);
    for (int ring = 0; ring < WEFT_RING_COUNT; ring++) {
        snprintf(name, sizeof name, "view_%d_deg", 15 * ring);
        weft_certificate_row(certificate, ring, line);
        weft_json_put(&described, name, json_string(line));
    }
    weft_certificate_describe_levels(certificate, line);
    if (line[0])
        weft_json_put(&described, "levels", json_string(line));
    return described;
}

static json_t *describe_heights(const weft_material_heights *heights)
{
    return json_pack("{s:[f,f], s:[i,i], s:i}", "range_mm", (double)heights->low_mm, (double)heights->high_mm, "places",
                     heights->width, heights->height, "levels", heights->level_count);
}

static json_t *describe_components(const weft_components *components)
{
    bool over_half_vector = weft_components_are_over_half_vector(components->kind);
    return json_pack("{s:i, s:s, s:b, s:f, s:[f, f], s:i, s:i}", "count", components->component_count, "maps_over",
                     over_half_vector ? "half vector" : "light", "kriged", weft_components_are_kriged(components->kind),
                     "exponent", (double)components->exponent, "powers", (double)components->incidence_power,
                     (double)components->cosine_power, "views", components->view_count, "images",
                     components->image_count);
}

static json_t *describe_material(const char *path, const weft_material *material, const weft_hold_out *held_out)
{
    /* First: reading numbers, jansson sets errno to 0. */
    json_t *metadata = parsed(material->metadata), *levels = json_array();
    for (int i = 0; i < material->level_count; i++)
        weft_json_append(&levels, describe_level(material, i));
    json_t *described =
        json_pack("{s:s, s:s, s:o, s:I, s:[ii], s:i, s:f, s:o, s:o}", "file", path, "kind", "material", "relative_rmse",
                  describe_error(material, held_out), "bytes", (json_int_t)weft_file_bytes(path), "texels",
                  material->level[0].width, material->level[0].height, "views_in_table", material->view_count,
                  "texel_pitch_mm", material->texel_pitch_mm, "levels", levels, "metadata", metadata);
    if (material->has_lobes)
        weft_json_put(&described, "lobes", json_integer(material->lobe_count));
    if (material->light_count > 0)
        weft_json_put(&described, "lights_in_table", json_integer(material->light_count));
    if (held_out && held_out->has_certificate)
        weft_json_put(&described, "certificate", describe_certificate(&held_out->certificate));
    if (material->components)
        weft_json_put(&described, "components", describe_components(material->components));
    if (material->heights)
        weft_json_put(&described, "heights", describe_heights(material->heights));
    return described;
}

static weft_code inspect_material(const char *path, json_t **result, weft_error *error)
{
    weft_material material;
    WEFT_TRY(weft_material_read(path, &material, error));
    weft_hold_out held_out;
    bool is_measured = false;
    weft_code code = weft_hold_out_read(material.metadata, &is_measured, &held_out, error);
    if (code == WEFT_OK)
        *result = describe_material(path, &material, is_measured ? &held_out : NULL);
    weft_material_free(&material);
    return code;
}

/* ---- Dataset ---- */

/* Smallest, median and largest of what is known about every image; nothing where nothing is. */
static void put_figures(json_t **described, const weft_dataset_layout *layout)
{
    static const char *const name[WEFT_IMAGE_FIGURES] = {
        [WEFT_IMAGE_WEIGHT] = "image_weights",
        [WEFT_IMAGE_VIEW_ERROR] = "view_standard_errors_deg",
        [WEFT_IMAGE_LIGHT_ERROR] = "light_standard_errors_deg",
        [WEFT_IMAGE_VALUE_ERROR] = "value_relative_standard_errors",
    };
    int count = layout->image_count;
    double *sorted = malloc((size_t)count * sizeof *sorted);
    for (int i = 0; i < WEFT_IMAGE_FIGURES; i++) {
        if (!layout->figure[i])
            continue;
        if (!sorted) {
            weft_json_put(described, name[i], NULL);
            continue;
        }
        memcpy(sorted, layout->figure[i], (size_t)count * sizeof *sorted);
        weft_json_put(described, name[i],
                      json_pack("{s:f, s:f, s:f}", "smallest", weft_quantile(sorted, count, 0), "median",
                                weft_quantile(sorted, count, 0.5), "largest", weft_quantile(sorted, count, 1)));
    }
    free(sorted);
}

static json_t *describe_dataset(const char *path, const weft_dataset *dataset)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    json_int_t raw =
        (json_int_t)layout->width * layout->height * layout->image_count * 3 * (json_int_t)sizeof(weft_half);
    json_t *described =
        json_pack("{s:s, s:s, s:I, s:I, s:[ii], s:i, s:i, s:s, s:s, s:s, s:f, s:o}", "file", path, "kind", "dataset",
                  "bytes", (json_int_t)weft_file_bytes(path), "half_float_bytes", raw, "texels", layout->width,
                  layout->height, "images", layout->image_count, "views", layout->view_count, "values",
                  layout->values == WEFT_REFLECTANCE ? "reflectance" : "reflectance times cosine", "lights_and_views",
                  layout->distance == WEFT_NEAR ? "positions (near)" : "directions (far)", "frames",
                  weft_dataset_has_frames(dataset) ? "given" : "of the surface", "texel_pitch_mm",
                  layout->texel_pitch_mm, "provenance", parsed(layout->provenance));
    put_figures(&described, layout);
    return described;
}

static weft_code inspect_dataset(const char *path, const weft_progress *progress, bool all, json_t **result,
                                 weft_error *error)
{
    weft_dataset *dataset;
    WEFT_TRY(weft_dataset_open(path, &dataset, error));
    *result = describe_dataset(path, dataset);
    weft_code code = all ? weft_verify_dataset(dataset, progress, *result, error) : WEFT_OK;
    weft_dataset_close(dataset);
    return code;
}

/* ---- Session ---- */

static json_t *describe_session(const weft_session *session)
{
    int taken = 0;
    for (int i = 0; i < session->shot_count; i++)
        taken += session->record[i].taken;
    return json_pack("{s:s, s:s, s:s, s:s, s:[ii], s:i, s:i, s:i, s:f}", "folder", session->folder, "kind", "session",
                     "rig", session->rig, "sample", session->sample, "photograph_size", session->camera.width,
                     session->camera.height, "bits", session->bits, "planned", session->shot_count, "taken", taken,
                     "opening_mm", session->target.opening_mm);
}

/* A description of each camera, and the numbers of all. */
static json_t *describe_cameras(const char *folder, const weft_session *sessions, int count)
{
    json_t *cameras = json_array();
    json_int_t planned = 0, taken = 0;
    for (int i = 0; i < count; i++) {
        json_t *one = describe_session(&sessions[i]);
        planned += json_integer_value(json_object_get(one, "planned"));
        taken += json_integer_value(json_object_get(one, "taken"));
        weft_json_append(&cameras, one);
    }
    return json_pack("{s:s, s:s, s:s, s:I, s:I, s:o}", "folder", folder, "kind", "session of several cameras", "sample",
                     sessions[0].sample, "planned", planned, "taken", taken, "cameras", cameras);
}

static weft_code inspect_cameras(const char *path, const weft_camera_list *list, const weft_progress *progress,
                                 bool all, json_t **result, weft_error *error)
{
    weft_session *sessions;
    int count;
    WEFT_TRY(weft_camera_sessions_open(path, &sessions, &count, error));
    *result = describe_cameras(path, sessions, count);
    weft_code code = all && *result ? weft_verify_cameras(path, sessions, list, progress, *result, error) : WEFT_OK;
    weft_camera_sessions_free(sessions, count);
    return code;
}

static bool holds_session(const char *folder)
{
    char path[PATH_MAX];
    return snprintf(path, sizeof path, "%s/session.json", folder) < (int)sizeof path && access(path, F_OK) == 0;
}

static weft_code inspect_session(const char *path, const weft_progress *progress, bool all, json_t **result,
                                 weft_error *error)
{
    weft_session session;
    weft_camera_list list;
    WEFT_TRY(weft_camera_list_read(path, &list, error));
    if (list.count > 0)
        return inspect_cameras(path, &list, progress, all, result, error);
    if (!holds_session(path))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' is a folder, but no session: it holds no session.json (weft photographs or weft import "
                         "makes a dataset of photographs)",
                         path);
    WEFT_TRY(weft_session_open(path, &session, error));
    *result = describe_session(&session);
    weft_code code = all ? weft_verify_session(&session, progress, *result, error) : WEFT_OK;
    weft_session_free(&session);
    return code;
}

/* ---- Weave ---- */

static weft_code inspect_weave(const char *path, json_t **result, weft_error *error)
{
    weft_weave weave;
    char warning[WEFT_MESSAGE_SIZE] = "";
    WEFT_TRY(weft_weave_read(path, NULL, 0, &weave, warning, error));
    *result = json_pack("{s:s, s:s, s:s, s:[ii], s:i, s:f}", "file", path, "kind", "weave", "name", weave.name,
                        "tile_cells", weave.tile_width, weave.tile_height, "yarns", weave.yarn_count, "specular_scale",
                        weave.specular_scale);
    if (warning[0])
        weft_json_put(result, "warning", json_string(warning));
    weft_weave_free(&weave);
    return WEFT_OK;
}

/* ---- Stitch ---- */

static weft_code inspect_stitch(const char *path, json_t **result, weft_error *error)
{
    weft_stitch stitch;
    weft_tile_mesh mesh;
    WEFT_TRY(weft_stitch_read(path, &stitch, error));
    weft_code code = weft_tile_mesh_create(&stitch, 0, path, &mesh, error);
    if (code == WEFT_OK) {
        *result = json_pack("{s:s, s:s, s:s, s:[ff], s:i, s:i, s:f, s:i, s:i}", "file", path, "kind", "stitch", "name",
                            stitch.name, "tile_mm", stitch.width, stitch.height, "yarns", stitch.yarn_count,
                            "resolution", stitch.resolution, "thickness_mm", (double)mesh.top - (double)mesh.bottom,
                            "vertices", mesh.vertex_count, "triangles", mesh.triangle_count);
        weft_tile_mesh_free(&mesh);
    }
    weft_stitch_free(&stitch);
    return code;
}

/* ---- Microcylinder cloth ---- */

static weft_code inspect_microcylinder(const char *path, json_t **result, weft_error *error)
{
    weft_microcylinder_description description;
    WEFT_TRY(weft_microcylinder_read(path, NULL, 0, &description, error));
    const weft_cloth_thread *thread = description.cloth.thread;
    *result = json_pack("{s:s, s:s, s:s, s:[ss], s:[ii], s:[ff], s:f}", "file", path, "kind", "microcylinder cloth",
                        "name", description.name, "axes", thread[0].axis == WEFT_AXIS_X ? "x" : "y",
                        thread[1].axis == WEFT_AXIS_X ? "x" : "y", "tangents", thread[0].sample_count,
                        thread[1].sample_count, "areas", thread[0].area_share, thread[1].area_share, "sigma_deg",
                        weft_deg_of_rad(description.cloth.sigma));
    return WEFT_OK;
}

/* ---- Any ---- */

static weft_code inspect_any(const char *path, const weft_progress *progress, bool all, json_t **result,
                             weft_error *error)
{
    *result = NULL;
    weft_file_kind kind;
    WEFT_TRY(weft_file_kind_of(path, &kind, error));
    errno = 0;
    weft_code code;
    if (kind == WEFT_FILE_MATERIAL)
        code = inspect_material(path, result, error);
    else if (kind == WEFT_FILE_DATASET)
        code = inspect_dataset(path, progress, all, result, error);
    else if (kind == WEFT_FILE_SESSION)
        code = inspect_session(path, progress, all, result, error);
    else if (kind == WEFT_FILE_STITCH)
        code = inspect_stitch(path, result, error);
    else if (kind == WEFT_FILE_MICROCYLINDER)
        code = inspect_microcylinder(path, result, error);
    else if (kind == WEFT_FILE_WEAVE)
        code = inspect_weave(path, result, error);
    else
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' is none of .btf.h5, .weft, .wv, .mc, .stitch or a session folder",
                         path);
    if (code == WEFT_OK && !*result)
        code = weft_json_fail(error, WEFT_BAD_INPUT, "'%s' cannot be described: its texts are not UTF-8", path);
    if (code != WEFT_OK && !json_object_get(*result, "faults")) {
        json_decref(*result);
        *result = NULL;
    }
    return code;
}

weft_code weft_inspect(const char *path, json_t **result, weft_error *error)
{
    return inspect_any(path, NULL, false, result, error);
}

weft_code weft_verify(const char *path, const weft_progress *progress, json_t **result, weft_error *error)
{
    return inspect_any(path, progress, true, result, error);
}

/* ---- As text ---- */

static weft_code as_text(weft_code code, json_t *description, char **json, weft_error *error)
{
    *json = NULL;
    if (code == WEFT_OK) {
        *json = json_dumps(description, JSON_INDENT(2));
        code = *json ? WEFT_OK : weft_fail_memory(error, "description", 0);
    }
    json_decref(description);
    return code;
}

weft_code weft_info(const char *path, char **json, weft_error *error)
{
    json_t *description;
    weft_code code = weft_inspect(path, &description, error);
    return as_text(code, description, json, error);
}

weft_code weft_check(const char *path, const weft_progress *progress, char **json, weft_error *error)
{
    json_t *description;
    weft_code code = weft_verify(path, progress, &description, error);
    return as_text(code, description, json, error);
}
