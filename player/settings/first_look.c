#include "player/settings/first_look.h"

#include "btf/material/material.h"
#include "player/scene/surroundings.h"

#include <stdlib.h>
#include <string.h>

static const double one_view_rad = WEFT_PI / 360;

/* Memory that is short is an error; what is wrong with a file, its reader will say. */
static weft_code of_reading(weft_code code)
{
    return weft_class_of(code) == WEFT_SYSTEM ? code : WEFT_OK;
}

static weft_code find_in_material(const char *path, bool *known, weft_measured *measured, weft_error *error)
{
    char *metadata = NULL;
    weft_code code = weft_material_read_metadata(path, &metadata, error);
    if (code != WEFT_OK)
        return of_reading(code);
    code = weft_measured_parse(metadata, known, measured, error);
    free(metadata);
    return code;
}

static weft_code find_in_dataset(const char *path, bool *known, weft_measured *measured, weft_error *error)
{
    weft_dataset *dataset = NULL;
    weft_code code = weft_dataset_open(path, &dataset, error);
    if (code != WEFT_OK)
        return of_reading(code);
    *measured = weft_measured_of(weft_dataset_get_layout(dataset));
    *known = true;
    weft_dataset_close(dataset);
    return WEFT_OK;
}

/* What the material, or else its dataset, was measured from; *known is false where it does not say. */
static weft_code find_measured(const weft_settings *settings, bool *known, weft_measured *measured, weft_error *error)
{
    *known = false;
    if (settings->material)
        return find_in_material(settings->material, known, measured, error);
    return settings->dataset ? find_in_dataset(settings->dataset, known, measured, error) : WEFT_OK;
}

static bool is_plane(const weft_settings *settings)
{
    return strcmp(settings->mesh, "plane") == 0;
}

/* As slant as the first view, and from below the picture's lower edge, so that x is to the right; less slant, or at
 * last as the first view, where that was not measured. */
static void look_from(weft_scene *scene, const weft_measured *measured)
{
    weft_orbit orbit = {.azimuth_rad = weft_rad_of_deg(-90), .distance = 3};
    double slant = acos(weft_clamp(measured->first_view.z, 0, 1));
    for (int step = 8; step >= 0; step--) {
        orbit.elevation_rad = weft_rad_of_deg(90) - slant * step / 8;
        scene->orbit = orbit;
        if (weft_cone_holds(&measured->view, weft_orbit_axes_of(&orbit).backward))
            return;
    }
    scene->orbit.azimuth_rad = atan2(measured->first_view.y, measured->first_view.x);
    scene->orbit.elevation_rad = weft_rad_of_deg(90) - slant;
}

static void light_from(weft_scene *scene, weft_vec3 light)
{
    scene->light[0].direction = weft_angles_of_direction(light);
}

/* Whether a level surface is seen and lit from measured directions, by default. */
static bool holds_default(const weft_measured *measured)
{
    weft_scene scene = weft_scene_default();
    return weft_cone_holds(&measured->view, weft_orbit_axes_of(&scene.orbit).backward) &&
           weft_cone_holds(&measured->light, weft_direction_of_angles(scene.light[0].direction));
}

static weft_code lay_flat(weft_settings *settings, weft_error *error)
{
    free(settings->mesh);
    settings->mesh = strdup("plane");
    return settings->mesh ? WEFT_OK : weft_fail_memory(error, "settings", 0);
}

/* Unless light was asked for, or its absence. */
static weft_code in_studio(weft_settings *settings, weft_error *error)
{
    char **environment = &settings->environment;
    if (settings->has_lights || weft_settings_has(settings, "environment"))
        return WEFT_OK;
    weft_settings_light(settings, weft_surroundings_names[0]);
    return weft_option_copy(weft_surroundings_names[0], environment, error);
}

weft_code weft_first_look(weft_settings *settings, weft_error *error)
{
    weft_measured measured;
    bool known;
    WEFT_TRY(find_measured(settings, &known, &measured, error));
    settings->is_of_one_view = known && measured.view.angle_rad < one_view_rad;
    if (settings->source)
        return WEFT_OK;
    if (is_plane(settings) && !weft_settings_has(settings, "camera"))
        settings->scene.orbit =
            (weft_orbit){.azimuth_rad = weft_rad_of_deg(-90), .elevation_rad = weft_rad_of_deg(75), .distance = 3};
    if (!known || holds_default(&measured))
        return in_studio(settings, error);
    if (!weft_settings_has(settings, "mesh"))
        WEFT_TRY(lay_flat(settings, error));
    if (!weft_settings_has(settings, "camera"))
        look_from(&settings->scene, &measured);
    if (!settings->has_lights && settings->scene.light_count > 0)
        light_from(&settings->scene, measured.first_light);
    return WEFT_OK;
}

void weft_first_fit(weft_settings *settings, const weft_mesh *mesh)
{
    const double margin = 0.93;
    weft_orbit *orbit = &settings->scene.orbit;
    weft_orbit_axes axes = weft_orbit_axes_of(orbit);
    float centre[3], radius;
    if (settings->source || weft_settings_has(settings, "camera"))
        return;
    weft_mesh_bounds(mesh, centre, &radius);
    for (int i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->vertex[i].position;
        weft_vec3 at = weft_vec3_of((weft_real)((p[0] - centre[0]) / radius), (weft_real)((p[1] - centre[1]) / radius),
                                    (weft_real)((p[2] - centre[2]) / radius));
        double aside = fmax(fabs((double)weft_dot(at, axes.right)), fabs((double)weft_dot(at, axes.up)));
        double needed = (double)weft_dot(at, axes.backward) + aside / (margin * weft_orbit_slope());
        orbit->distance = fmax(orbit->distance, needed);
    }
}
