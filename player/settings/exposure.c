#include "player/settings/exposure.h"

#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 160, HEIGHT = 100 };

/* The brightest of the mesh: from here to there of its pixels in ascending order. The very brightest are glints. */
static const double brightest_from = 0.95, brightest_to = 0.99;

static const double white = 1, dimmest_white = 0.7, dimmest_mean = 0.1, brightest_mean = 0.17;

/* What is darker than this share of the brightest counts as so dark: it looks black either way. */
static const double black = 0.01;

/* Of a cone: within it all directions are one. */
static const double one_direction_rad = WEFT_PI / 180;

/* The first mode that is shown, small, alone, and as bright as reflectance. */
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

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static double mean_of(const float *value, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)value[i];
    return sum / (double)count;
}

/* None of them counts as less than `least`. */
static double geometric_mean(const float *value, size_t count, double least)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += log(fmax((double)value[i], least));
    return exp(sum / (double)count);
}

double weft_exposure_for_picture(float *value, size_t count, bool has_ground)
{
    if (count == 0)
        return 1;
    qsort(value, count, sizeof *value, by_value);
    size_t from = (size_t)(brightest_from * (double)(count - 1)), to = (size_t)(brightest_to * (double)(count - 1));
    double bright = mean_of(value + from, to - from + 1);
    if (!(bright > 0))
        return 1;
    double mean = geometric_mean(value, count, black * bright);
    double exposure = weft_clamp(1, dimmest_white / bright, white / bright);
    double most = has_ground ? fmax(1, brightest_mean / mean) : exposure;
    exposure = weft_clamp(exposure, fmin(1, dimmest_mean / mean), most);
    return weft_clamp(exposure, 1e-6, 1e6);
}

weft_code weft_expose(const weft_settings *settings, weft_player *player, weft_scene *scene, bool *changed,
                      weft_error *error)
{
    *changed = false;
    if (settings->source || weft_settings_has(settings, "exposure") || scene->layout == WEFT_LAYOUT_DIFFERENCE)
        return WEFT_OK;
    weft_scene small = small_scene(scene);
    weft_surface_sample *surface = NULL;
    weft_image image = {0};
    size_t count = 0;
    WEFT_TRY(weft_player_picture(player, &small, WIDTH, HEIGHT, 1, NULL, &image, error));
    weft_code code = weft_player_read_surface(player, &small, small.pane[0], WIDTH, HEIGHT, &surface, error);
    if (code == WEFT_OK) {
        gather_bright(&image, surface, &count);
        scene->exposure = weft_exposure_for_picture(image.pixels, count, scene->ground);
        *changed = scene->exposure != 1;
    }
    free(surface);
    weft_image_free(&image);
    return code;
}

/* Where all photographs share one direction nearly everything lies beyond them, whatever the picture shows. */
static bool is_one_direction(const weft_cone *cone)
{
    return cone->angle_rad < one_direction_rad;
}

enum { SHARE_SIZE = 80 };

/* Of view or light: every one but that of the photographs, or what share of the cloth `does`. */
static void describe_share(const weft_cone *cone, const char *every, const char *does, long beyond, long covered,
                           char text[SHARE_SIZE])
{
    if (is_one_direction(cone))
        snprintf(text, SHARE_SIZE, "every %s but one", every);
    else
        snprintf(text, SHARE_SIZE, "%.0f %% %s", 100.0 * (double)beyond / (double)covered, does);
}

weft_code weft_describe_unmeasured(const weft_settings *settings, weft_player *player, const weft_scene *scene,
                                   char text[WEFT_MESSAGE_SIZE], weft_error *error)
{
    const weft_measured *measured = &settings->measured[scene->pane[0]];
    weft_surface_sample *surface;
    text[0] = 0;
    if (!settings->knows_measured[scene->pane[0]])
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
    if (covered == 0 || 100 * (seen > lit ? seen : lit) < covered)
        return WEFT_OK;
    char of_views[SHARE_SIZE], of_lights[SHARE_SIZE];
    const char *of_cloth = is_one_direction(&measured->view) ? "of the lit cloth is lit from where none was taken"
                                                             : "is lit from where none was taken";
    describe_share(&measured->view, "view", "of the lit cloth is seen", seen, covered, of_views);
    describe_share(&measured->light, "light", of_cloth, lit, covered, of_lights);
    snprintf(text, WEFT_MESSAGE_SIZE, "beyond the photographs: %s, %s", of_views, of_lights);
    return WEFT_OK;
}
