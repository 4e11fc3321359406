#include "compare/pictures/visible_error.h"

#include <stdlib.h>

bool weft_surface_is_lit(const weft_surface_sample *sample)
{
    return sample->covered > 0.5f && sample->light[2] > 0;
}

weft_code weft_visible_error_of(const weft_image *data, const weft_image *model, const weft_surface_sample *surface,
                                weft_error_summary *result, weft_error *error)
{
    size_t pixels = (size_t)data->width * (size_t)data->height;
    weft_compared *value = malloc(3 * pixels * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "visible pixels", 3 * pixels * sizeof *value);
    size_t count = 0;
    for (size_t i = 0; i < 3 * pixels; i++) {
        if (weft_surface_is_lit(&surface[i / 3]))
            value[count++] = (weft_compared){.sample = data->pixels[i], .prediction = model->pixels[i]};
    }
    weft_code code = weft_error_summary_of(value, count, result, error);
    free(value);
    return code;
}

/* By themselves, under the lights alone: choices at random among many lights would count as errors. */
static weft_scene bare(const weft_scene *scene)
{
    weft_scene bare = *scene;
    bare.layout = WEFT_LAYOUT_PANES;
    bare.pane_count = 1;
    bare.labels = bare.show_level = bare.show_extrapolation = bare.environment = bare.ground = false;
    bare.key_size_rad = 0;
    weft_scene_keep_lit(&bare);
    return bare;
}

static weft_code draw_alone(weft_player *player, weft_scene scene, weft_mode mode, int width, int height,
                            weft_image *image, weft_error *error)
{
    scene.pane[0] = mode;
    return weft_player_picture(player, &scene, width, height, 1, NULL, image, error);
}

weft_code weft_visible_error_measure(weft_player *player, const weft_scene *scene, weft_mode mode, int width,
                                     int height, weft_error_summary *result, weft_error *error)
{
    weft_image data = {0}, model = {0};
    weft_surface_sample *surface = NULL;
    weft_scene alone = bare(scene);
    weft_code code = draw_alone(player, alone, WEFT_MODE_RAW, width, height, &data, error);
    if (code == WEFT_OK)
        code = draw_alone(player, alone, mode, width, height, &model, error);
    if (code == WEFT_OK)
        code = weft_player_read_surface(player, &alone, mode, width, height, &surface, error);
    if (code == WEFT_OK)
        code = weft_visible_error_of(&data, &model, surface, result, error);
    weft_image_free(&data);
    weft_image_free(&model);
    free(surface);
    return code;
}
