#include "player/settings/first_look.h"

#include "btf/material/material.h"

#include <stdlib.h>
#include <string.h>

/* What the request's material, or else its dataset, was measured from; false where it does not say. */
static bool find_measured(const weft_settings *settings, weft_measured *measured)
{
    char *metadata = NULL;
    weft_dataset *dataset = NULL;
    bool known = false;
    if (settings->material && weft_material_read_metadata(settings->material, &metadata, NULL) == WEFT_OK) {
        known = weft_measured_parse(metadata, measured);
        free(metadata);
    } else if (!settings->material && settings->dataset &&
               weft_dataset_open(settings->dataset, &dataset, NULL) == WEFT_OK) {
        *measured = weft_measured_of(weft_dataset_get_layout(dataset));
        known = true;
        weft_dataset_close(dataset);
    }
    return known;
}

static bool is_plane(const weft_scene_request *request)
{
    return strcmp(request->settings.mesh, "plane") == 0;
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

weft_code weft_first_look(weft_scene_request *request, weft_error *error)
{
    weft_settings *settings = &request->settings;
    weft_measured measured;
    if (request->source)
        return WEFT_OK;
    if (is_plane(request) && !request->has_camera)
        settings->scene.orbit =
            (weft_orbit){.azimuth_rad = weft_rad_of_deg(-90), .elevation_rad = weft_rad_of_deg(75), .distance = 3};
    if (!find_measured(settings, &measured) || holds_default(&measured))
        return WEFT_OK;
    if (!weft_scene_request_has(request, "mesh"))
        WEFT_TRY(lay_flat(settings, error));
    if (!request->has_camera)
        look_from(&settings->scene, &measured);
    if (!request->has_lights && settings->scene.light_count > 0)
        light_from(&settings->scene, measured.first_light);
    return WEFT_OK;
}
