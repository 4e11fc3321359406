#include "edit/prune/steps.h"

#include "compare/pictures/picture_quality.h"
#include "player/draw/canvas.h"

#include <stdlib.h>

enum { MOST_SAMPLES = 3 };

/* The compressed material alone, without what is drawn over it. */
static weft_scene scene_at(const weft_prune_scene *s, double time_s)
{
    weft_scene scene = s->scene;
    scene.layout = WEFT_LAYOUT_PANES;
    scene.pane_count = 1;
    scene.pane[0] = WEFT_MODE_COMPRESSED;
    scene.show_level = scene.show_extrapolation = scene.labels = false;
    if (s->path)
        weft_path_apply(s->path, time_s, &scene);
    return scene;
}

/* A few frames on a grid within each pixel: of the levels of the picture that they are a part of. */
static weft_code add_frames(weft_player *player, const weft_prune_scene *s, const weft_scene *scene,
                            weft_canvas *canvas, weft_error *error)
{
    int side = s->samples < MOST_SAMPLES ? s->samples : MOST_SAMPLES;
    for (int i = 0; i < side * side; i++) {
        const weft_sampling sampling = {.shift_x = (i % side + 0.5) / side - 0.5,
                                        .shift_y = ((int)(i / side) + 0.5) / side - 0.5,
                                        .level_bias = -log2(s->samples),
                                        .longest_pixel = s->samples,
                                        .frame = i};
        weft_canvas_begin_frame(canvas);
        WEFT_TRY(weft_player_draw(player, scene, s->width, s->height, sampling, error));
        weft_canvas_end_frame(canvas);
    }
    return WEFT_OK;
}

static weft_code draw_frames(weft_player *player, const weft_prune_scene *s, const weft_scene *scene, weft_image *image,
                             weft_error *error)
{
    weft_canvas canvas = {0};
    weft_code code = weft_canvas_create(s->width, s->height, &canvas, error);
    if (code == WEFT_OK)
        code = add_frames(player, s, scene, &canvas, error);
    if (code == WEFT_OK)
        code = weft_canvas_read(&canvas, image, error);
    weft_canvas_free(&canvas);
    return code;
}

static weft_code draw(const weft_prune_pictures *p, int i, int components, weft_image *image, weft_error *error)
{
    const weft_prune_scene *s = p->scene;
    weft_scene scene = scene_at(s, p->time_s[i]);
    scene.components = scene.components < components ? scene.components : components;
    if (p->whole)
        WEFT_TRY(weft_player_picture(p->player, &scene, s->width, s->height, s->samples, NULL, image, error));
    else
        WEFT_TRY(draw_frames(p->player, s, &scene, image, error));
    weft_scene_show(&scene, image);
    return WEFT_OK;
}

/* Where the mesh is. */
static weft_code find_cover(weft_prune_pictures *p, int i, weft_error *error)
{
    int pixels = p->scene->width * p->scene->height;
    weft_scene scene = scene_at(p->scene, p->time_s[i]);
    weft_surface_sample *sample;
    WEFT_TRY(weft_player_read_surface(p->player, &scene, WEFT_MODE_COMPRESSED, p->scene->width, p->scene->height,
                                      &sample, error));
    p->covered[i] = calloc((size_t)pixels, 1);
    for (int pixel = 0; p->covered[i] && pixel < pixels; pixel++)
        p->covered[i][pixel] = sample[pixel].covered > 0;
    free(sample);
    return p->covered[i] ? WEFT_OK : weft_fail_memory(error, "cover", (size_t)pixels);
}

weft_code weft_prune_pictures_draw(weft_player *player, const weft_prune_scene *scene, bool whole, const double *time_s,
                                   int count, weft_prune_pictures *p, weft_error *error)
{
    *p = (weft_prune_pictures){.player = player, .scene = scene, .whole = whole};
    for (int i = 0; i < count; i++) {
        p->time_s[i] = time_s[i];
        WEFT_TRY(draw(p, i, WEFT_COMPONENTS_MAX, &p->shown[i], error));
        p->count++;
        WEFT_TRY(find_cover(p, i, error));
    }
    return WEFT_OK;
}

void weft_prune_pictures_free(weft_prune_pictures *p)
{
    for (int i = 0; i < p->count; i++) {
        weft_image_free(&p->shown[i]);
        free(p->covered[i]);
    }
    *p = (weft_prune_pictures){0};
}

/* ---- Comparing ---- */

typedef struct difference_sums {
    double squares, flip;
    long pixels;
} difference_sums;

/* The mean of FLIP is that of all pixels; those beside the mesh are alike. */
static weft_code add_picture(const weft_prune_pictures *p, int i, const weft_image *test, difference_sums *sums,
                             weft_error *error)
{
    long covered = 0, all = (long)test->width * test->height;
    weft_picture_quality quality;
    WEFT_TRY(weft_picture_quality_measure(&p->shown[i], test, &quality, error));
    for (long pixel = 0; pixel < all; pixel++) {
        covered += p->covered[i][pixel];
        for (int c = 0; p->covered[i][pixel] && c < 3; c++) {
            double difference = (double)test->pixels[3 * pixel + c] - (double)p->shown[i].pixels[3 * pixel + c];
            sums->squares += difference * difference / 3;
        }
    }
    sums->flip += quality.flip * (double)all;
    sums->pixels += covered;
    return WEFT_OK;
}

weft_code weft_prune_pictures_compare(const weft_prune_pictures *p, int components, weft_prune_error *result,
                                      weft_error *error)
{
    difference_sums sums = {0};
    for (int i = 0; i < p->count; i++) {
        weft_image test = {0};
        weft_code code = draw(p, i, components, &test, error);
        if (code == WEFT_OK)
            code = add_picture(p, i, &test, &sums, error);
        weft_image_free(&test);
        WEFT_TRY(code);
    }
    double pixels = (double)(sums.pixels > 0 ? sums.pixels : 1);
    *result = (weft_prune_error){255 * sqrt(sums.squares / pixels), sums.flip / pixels};
    return WEFT_OK;
}
