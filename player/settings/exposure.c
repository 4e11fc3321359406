#include "player/settings/exposure.h"

#include "base/numeric/statistics.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 160, HEIGHT = 100 };

static const double brightest_share = 0.98, white = 0.9, dimmest_white = 0.5, dimmest_mean = 0.1, brightest_mean = 0.17;

/* What the request shows first, small, alone, and as bright as reflectance. */
static weft_scene small_scene(const weft_scene *scene)
{
    weft_scene small = *scene;
    small.layout = WEFT_LAYOUT_PANES;
    small.pane_count = 1;
    small.exposure = 1;
    small.shadows = small.ground = false;
    small.labels = small.show_level = small.show_extrapolation = small.environment_reference = false;
    return small;
}

/* The largest channel of every pixel of the mesh, in the first *count of `image`. */
static void gather_bright(weft_image *image, const weft_surface_sample *surface, size_t *count)
{
    *count = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float *rgb = image->pixels + 3 * i;
        if (surface[i].covered > 0)
            image->pixels[(*count)++] = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    }
}

static double exposure_for(float *value, size_t count, bool has_ground)
{
    double sum = 0, positive = 0;
    for (size_t i = 0; i < count; i++) {
        if (value[i] > 0) {
            sum += log((double)value[i]);
            positive++;
        }
    }
    double bright = (double)weft_quantile_of_floats(value, count, (float)brightest_share);
    if (!(bright > 0) || (bright >= dimmest_white && bright <= 1))
        return 1;
    double mean = exp(sum / positive), exposure = white / bright;
    if (bright > 1)
        exposure = fmax(exposure, dimmest_mean / mean);
    else if (has_ground)
        exposure = fmin(exposure, brightest_mean / mean);
    return weft_clamp(exposure, 1e-6, 1e6);
}

weft_code weft_expose(const weft_scene_request *request, weft_player *player, weft_scene *scene, bool *changed,
                      weft_error *error)
{
    *changed = false;
    if (request->source || weft_scene_request_has(request, "exposure") || scene->layout == WEFT_LAYOUT_DIFFERENCE)
        return WEFT_OK;
    weft_scene small = small_scene(scene);
    weft_surface_sample *surface = NULL;
    weft_image image = {0};
    size_t count = 0;
    WEFT_TRY(weft_player_picture(player, &small, WIDTH, HEIGHT, 1, NULL, &image, error));
    weft_code code = weft_player_read_surface(player, &small, small.pane[0], WIDTH, HEIGHT, &surface, error);
    if (code == WEFT_OK) {
        gather_bright(&image, surface, &count);
        scene->exposure = exposure_for(image.pixels, count, scene->ground);
        *changed = scene->exposure != 1;
    }
    free(surface);
    weft_image_free(&image);
    return code;
}

weft_code weft_describe_unmeasured(const weft_scene_request *request, weft_player *player, const weft_scene *scene,
                                   char text[WEFT_MESSAGE_SIZE], weft_error *error)
{
    const weft_measured *measured = &request->measured[scene->pane[0]];
    weft_surface_sample *surface;
    text[0] = 0;
    if (!request->knows_measured[scene->pane[0]])
        return WEFT_OK;
    weft_scene small = small_scene(scene);
    WEFT_TRY(weft_player_read_surface(player, &small, small.pane[0], WIDTH, HEIGHT, &surface, error));
    long covered = 0, seen = 0, lit = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const float *l = surface[i].light, *v = surface[i].view;
        if (!(surface[i].covered > 0) || l[2] <= 0)
            continue;
        covered++;
        seen += !weft_cone_holds(&measured->view, weft_vec3_of(v[0], v[1], v[2]));
        lit += scene->light_count > 0 && !weft_cone_holds(&measured->light, weft_vec3_of(l[0], l[1], l[2]));
    }
    free(surface);
    if (covered > 0 && 100 * (seen > lit ? seen : lit) >= covered)
        snprintf(text, WEFT_MESSAGE_SIZE,
                 "beyond the photographs: %.0f %% of the lit cloth is seen, %.0f %% is lit from where none was taken",
                 100.0 * (double)seen / (double)covered, 100.0 * (double)lit / (double)covered);
    return WEFT_OK;
}
