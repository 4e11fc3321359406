#include "compare/pictures/scene_error.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void append(char text[WEFT_SCENE_ERROR_SIZE], weft_mode mode, const weft_error_summary *e)
{
    size_t used = strlen(text);
    snprintf(text + used, WEFT_SCENE_ERROR_SIZE - used,
             "%s%s %.1f %% (median %.1f, 80th percentile %.1f; PSNR %.1f dB)",
             used > 0 ? ", " : "from raw: ", weft_mode_name(mode), 100 * e->relative_rmse, 100 * e->median_relative,
             100 * e->percentile80_relative, e->psnr_db);
}

weft_code weft_scene_error_describe(weft_player *player, const weft_scene *scene, int width, int height,
                                    char text[WEFT_SCENE_ERROR_SIZE], weft_error *error)
{
    text[0] = 0;
    int panes = weft_scene_panes(scene), pane_width = scene->layout == WEFT_LAYOUT_PANES ? width / panes : width;
    if (!weft_player_has(player, WEFT_MODE_RAW) || pane_width < 1)
        return WEFT_OK;
    for (int i = 0; i < panes; i++) {
        weft_error_summary e;
        if (scene->pane[i] == WEFT_MODE_RAW)
            continue;
        WEFT_TRY(weft_visible_error_measure(player, scene, scene->pane[i], pane_width, height, &e, error));
        append(text, scene->pane[i], &e);
    }
    return WEFT_OK;
}

/* ---- Environments ---- */

static double relative_rmse(const weft_image *image, const weft_image *reference, const weft_surface_sample *surface)
{
    weft_error_sums sums = {0};
    for (size_t i = 0; i < 3 * (size_t)image->width * (size_t)image->height; i++) {
        if (surface[i / 3].covered > 0.5f)
            weft_error_sums_add_value(&sums, (double)reference->pixels[i], (double)image->pixels[i]);
    }
    return weft_error_sums_relative_rmse(&sums);
}

weft_code weft_environment_error_describe(weft_player *player, const weft_settings *settings,
                                          char text[WEFT_SCENE_ERROR_SIZE], weft_error *error)
{
    const weft_scene *scene = &settings->scene;
    int width = (settings->width + 3) / 4, height = (settings->height + 3) / 4;
    text[0] = 0;
    if (!scene->environment || !scene->environment_reference || !weft_player_has_environment(player))
        return WEFT_OK;
    weft_scene alone = *scene;
    alone.layout = WEFT_LAYOUT_PANES;
    alone.pane_count = 1;
    alone.labels = alone.show_level = alone.show_extrapolation = false;
    weft_image exact = {0}, fast = {0};
    weft_surface_sample *surface = NULL;
    weft_code code = weft_player_picture(player, &alone, width, height, settings->samples, NULL, &exact, error);
    alone.environment_reference = false;
    if (code == WEFT_OK)
        code = weft_player_picture(player, &alone, width, height, settings->samples, NULL, &fast, error);
    if (code == WEFT_OK)
        code = weft_player_read_surface(player, &alone, alone.pane[0], width, height, &surface, error);
    if (code == WEFT_OK)
        snprintf(text, WEFT_SCENE_ERROR_SIZE, "without --environment-reference: relative RMSE %.2f %%",
                 100 * relative_rmse(&fast, &exact, surface));
    weft_image_free(&exact);
    weft_image_free(&fast);
    free(surface);
    return code;
}

/* ---- Visible error ---- */

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
