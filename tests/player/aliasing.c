#include "aliasing.h"

#include <math.h>
#include <stdlib.h>

weft_scene aliasing_scene(int height)
{
    weft_scene scene = weft_scene_default();
    scene.orbit.distance = 7;
    scene.repeat = 7.0 * height / 150;
    scene.pane_count = 1;
    scene.pane[0] = WEFT_MODE_COMPRESSED;
    return scene;
}

static bool inside(const weft_surface_sample *surface, int width, int height, int x, int y)
{
    if (x < 1 || y < 1 || x >= width - 1 || y >= height - 1)
        return false;
    for (int i = 0; i < 9; i++) {
        if (surface[(y + i / 3 - 1) * width + x + i % 3 - 1].covered == 0)
            return false;
    }
    return true;
}

static double energy(const weft_surface_sample *surface, const weft_image *image, const weft_image *reference,
                     long *pixels)
{
    double sum = 0;
    *pixels = 0;
    for (int i = 0; i < image->width * image->height; i++) {
        if (!inside(surface, image->width, image->height, i % image->width, i / image->width))
            continue;
        for (int c = 0; c < 3; c++) {
            double difference = (double)image->pixels[3 * i + c] - (double)reference->pixels[3 * i + c];
            sum += difference * difference;
        }
        ++*pixels;
    }
    return *pixels > 0 ? sum / (3.0 * (double)*pixels) : 0;
}

weft_code aliasing_measure(weft_player *player, weft_scene scene, int width, int height, int samples, aliasing *a,
                           weft_error *error)
{
    weft_surface_sample *surface = NULL;
    *a = (aliasing){0};
    scene.level_choice = WEFT_LEVEL_NONE;
    weft_code code = weft_player_picture(player, &scene, width, height, 1, NULL, &a->without, error);
    if (code == WEFT_OK)
        code = weft_player_picture(player, &scene, width, height, samples, NULL, &a->reference, error);
    scene.level_choice = WEFT_LEVEL_TRILINEAR;
    if (code == WEFT_OK)
        code = weft_player_picture(player, &scene, width, height, 1, NULL, &a->with, error);
    if (code == WEFT_OK)
        code = weft_player_read_surface(player, &scene, WEFT_MODE_COMPRESSED, width, height, &surface, error);
    if (code == WEFT_OK) {
        a->energy_without = energy(surface, &a->without, &a->reference, &a->pixels);
        a->energy_with = energy(surface, &a->with, &a->reference, &a->pixels);
    }
    free(surface);
    return code;
}

void aliasing_free(aliasing *a)
{
    weft_image_free(&a->without);
    weft_image_free(&a->with);
    weft_image_free(&a->reference);
}
