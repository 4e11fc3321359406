/* Aliasing energy of the drape seen from afar, with mip levels and without, against 16 x 16 samples a pixel of level 0.
 * Usage: bench_aliasing [NAME.weft] [PICTURE.png]; without a material, a checkerboard of one texel a field. The picture
 * shows, from the left: without, with, reference. */
#include "../tests/player/aliasing.h"
#include "../tests/player/stage.h"

#include "base/picture/colour.h"

#include <stdio.h>
#include <string.h>

/* The picture shows CROP x CROP pixels around the drape, enlarged without smoothing. */
enum { WIDTH = 320, HEIGHT = 300, SAMPLES = 16, PANES = 3, CROP = 150, ENLARGED = 2 };

static void copy_pane(const weft_image *pane, int index, weft_image *picture)
{
    const int side = CROP * ENLARGED, left = (WIDTH - CROP) / 2, top = (HEIGHT - CROP) / 2;
    for (int i = 0; i < side * side; i++) {
        int x = i % side, y = i / side;
        const float *from = pane->pixels + 3 * ((top + y / ENLARGED) * pane->width + left + x / ENLARGED);
        float *to = picture->pixels + 3 * (y * picture->width + index * side + x);
        for (int c = 0; c < 3; c++)
            to[c] = weft_srgb_of_linear(from[c]);
    }
}

static void write_picture(const char *path, const aliasing *a)
{
    weft_error error = {0};
    weft_image picture;
    expect_ok(weft_image_create(PANES * CROP * ENLARGED, CROP * ENLARGED, &picture, &error), &error);
    copy_pane(&a->without, 0, &picture);
    copy_pane(&a->with, 1, &picture);
    copy_pane(&a->reference, 2, &picture);
    expect_ok(weft_image_write(path, &picture, "without mip levels, with, 16 x 16 samples a pixel", &error), &error);
    weft_image_free(&picture);
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    const char *material_path = NULL, *picture_path = NULL;
    for (int i = 1; i < argc; i++)
        *(strstr(argv[i], ".weft") ? &material_path : &picture_path) = argv[i];
    weft_material material;
    if (material_path)
        expect_ok(weft_material_read(material_path, &material, &error), &error);
    else
        stage_checker(32, &material);
    void *state;
    stage_open(&state);
    stage *s = state;
    aliasing a;
    expect_ok(weft_player_set_material(s->player, &material, &error), &error);
    expect_ok(aliasing_measure(s->player, aliasing_scene(HEIGHT), WIDTH, HEIGHT, SAMPLES, &a, &error), &error);
    printf("%s: aliasing energy %.4g without mip levels, %.4g with them, %.1f times lower, %ld pixels, %s\n",
           material_path ? material_path : "checkerboard", a.energy_without, a.energy_with,
           a.energy_without / a.energy_with, a.pixels, weft_gl_renderer());
    if (picture_path)
        write_picture(picture_path, &a);
    aliasing_free(&a);
    weft_material_free(&material);
    return stage_close(&state);
}
