#include "player/scene/scene.h"

#include "base/picture/colour.h"

#include <math.h>
#include <stddef.h>

const char *const weft_mode_names[] = {"raw", "compressed", "analytic", NULL};

const char *weft_mode_name(weft_mode mode)
{
    return weft_mode_names[mode];
}

weft_scene weft_scene_default(void)
{
    return (weft_scene){
        .orbit = {weft_rad_of_deg(-70), weft_rad_of_deg(28), 3.6},
        .light = {{{weft_rad_of_deg(45), weft_rad_of_deg(-110)}, {1, 1, 1}}},
        .light_count = 1,
        .environment_strength = 1,
        .exposure = 1,
        .repeat = 8,
        .pane_count = 1,
        .pane = {WEFT_MODE_COMPRESSED},
        .divider = 0.5,
        .relief = true,
        .lobe = {true, true, true},
        .view_table = true,
        .light_table = true,
        .components = 64,
        .labels = true,
    };
}

int weft_scene_panes(const weft_scene *scene)
{
    return scene->layout == WEFT_LAYOUT_PANES ? scene->pane_count : 2;
}

bool weft_scene_has_shadows(const weft_scene *scene)
{
    return scene->shadows && (scene->light_count > 0 || scene->environment);
}

weft_scene weft_scene_in_bare_light(const weft_scene *scene)
{
    weft_scene bare = *scene;
    bare.light[0] = weft_scene_default().light[0];
    bare.light_count = 1;
    bare.key_size_rad = 0;
    bare.environment = bare.ground = false;
    return bare;
}

void weft_scene_keep_lit(weft_scene *scene)
{
    if (scene->environment || scene->light_count > 0)
        return;
    scene->light[0] = weft_scene_default().light[0];
    scene->light_count = 1;
}

static float tone_of_linear(weft_tone tone, float linear)
{
    float above = fmaxf(linear - 0.5f, 0);
    return tone == WEFT_TONE_SOFT ? fminf(linear, 0.5f) + above / (1 + 2 * above) : linear;
}

void weft_scene_show(const weft_scene *scene, weft_image *image)
{
    double line = scene->divider * image->width;
    for (int i = 0; i < image->width * image->height; i++) {
        float *rgb = image->pixels + 3 * (size_t)i;
        if (scene->layout == WEFT_LAYOUT_DIFFERENCE)
            weft_difference_colour(weft_channel_mean(rgb) / WEFT_SCENE_FULL_DIFFERENCE, rgb);
        bool on_line = scene->layout == WEFT_LAYOUT_WIPE && fabs(i % image->width + 0.5 - line) < 1;
        for (int c = 0; c < 3 && scene->layout != WEFT_LAYOUT_DIFFERENCE; c++)
            rgb[c] = on_line ? 0.95f : weft_srgb_of_linear(fminf(tone_of_linear(scene->tone, rgb[c]), 1));
    }
}
