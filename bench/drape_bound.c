/* What bounds a BTF on the drape, by pictures of the geometry of a stitch (docs/notes/truth.md): the noise of
 * the truth itself, as another seed tells; a BTF without fault, which is asked of the flat stitch for every place,
 * light and view by itself; and what the player makes of a dataset with more samples a pixel or on the finest level
 * alone. Usage: bench_drape_bound STITCH DATASET.btf.h5 PICTURES/ [PATHS [SIDE]] */
#include "bench/faultless_btf.h"
#include "compare/truth/comparison.h"
#include "geometry/drape/draped_cloth.h"
#include "player/draw/player.h"
#include "player/gl/context.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double most_triangles = 12e6;

enum { BOUNCES = 3 };

static void stop_on(weft_code code, const weft_error *error)
{
    if (code == WEFT_OK)
        return;
    fprintf(stderr, "bench_drape_bound: %s\n", error->message);
    exit((int)code);
}

/* ---- The scene: the first of weft compare --truth ---- */

static weft_scene make_scene(void)
{
    weft_scene scene = weft_scene_default();
    scene.light[0].direction = (weft_angles){weft_rad_of_deg(40), weft_rad_of_deg(-130)};
    scene.orbit.azimuth_rad = weft_rad_of_deg(-70);
    scene.orbit.elevation_rad = weft_rad_of_deg(28);
    scene.repeat = WEFT_TRUTH_REPEAT;
    scene.labels = false;
    scene.pane[0] = WEFT_MODE_RAW;
    scene.shadows = true;
    return scene;
}

/* As coarse as weft compare --truth has it where the drape would have too many triangles. */
static int cells_of(const weft_stitch *stitch, const char *path)
{
    weft_error error = {0};
    weft_tile_mesh tile;
    stop_on(weft_tile_mesh_create(stitch, 0, path, &tile, &error), &error);
    double tiles = WEFT_TRUTH_REPEAT * ceil(WEFT_TRUTH_REPEAT * stitch->width / stitch->height);
    double share = most_triangles / (tiles * tile.triangle_count);
    weft_tile_mesh_free(&tile);
    return share >= 1 ? 0 : (int)(stitch->resolution * sqrt(share));
}

static double plane_of(const weft_dataset_layout *layout)
{
    json_t *provenance = json_loads(layout->provenance, 0, NULL);
    double moved = json_number_value(json_object_get(json_object_get(provenance, "relief"), "moved_mm"));
    double below = json_number_value(json_object_get(provenance, "plane_below_top_mm"));
    json_decref(provenance);
    return moved - below;
}

/* ---- Pictures ---- */

typedef struct stage {
    weft_player *player;
    weft_surface_sample *surface;
    weft_image truth;
    int side;
    const char *folder; /* of the pictures; "": none are kept */
} stage;

static weft_image draw(const stage *s, const weft_scene *scene, int samples)
{
    weft_error error = {0};
    weft_image image;
    stop_on(weft_player_picture(s->player, scene, s->side, s->side, samples, NULL, &image, &error), &error);
    return image;
}

static void keep(const stage *s, const char *what, const weft_image *image)
{
    weft_error error = {0};
    char path[512];
    snprintf(path, sizeof path, "%s%s.exr", s->folder, what);
    if (s->folder[0])
        stop_on(weft_image_write(path, image, what, &error), &error);
}

static void report(const stage *s, const char *what, weft_image *image)
{
    weft_error error = {0};
    weft_truth_error e;
    stop_on(weft_truth_error_of(&s->truth, image, s->surface, &e, &error), &error);
    printf("%-40s %.4f, of blocks %.4f\n", what, e.error.relative_rmse, e.block_relative_rmse);
    fflush(stdout);
    keep(s, what, image);
    weft_image_free(image);
}

static void report_raw(const stage *s, weft_scene scene)
{
    static const int samples[] = {3, 6};
    for (int i = 0; i < 8; i++) {
        char what[80];
        scene.relief = i / 2 % 2 == 0;
        scene.level_choice = i < 4 ? WEFT_LEVEL_TRILINEAR : WEFT_LEVEL_NONE;
        snprintf(what, sizeof what, "raw %s, %s, %d x %d samples", i / 2 % 2 ? "flat" : "through heights",
                 i < 4 ? "levels" : "finest level", samples[i % 2], samples[i % 2]);
        weft_image image = draw(s, &scene, samples[i % 2]);
        report(s, what, &image);
    }
}

static weft_image draw_background(const weft_scene *scene, stage *s)
{
    weft_error error = {0};
    weft_mesh nothing;
    stop_on(weft_mesh_allocate(3, 1, &nothing, &error), &error);
    for (int i = 0; i < 3; i++)
        nothing.vertex[i] = (weft_vertex){.position = {(float)i, 0, 0}, .normal = {0, 0, 1}, .tangent = {1, 0, 0, 1}};
    for (uint32_t i = 0; i < 3; i++)
        nothing.index[0][i] = i;
    stop_on(weft_player_set_mesh(s->player, &nothing, &error), &error);
    weft_mesh_free(&nothing);
    return draw(s, scene, 1);
}

static weft_image trace(const weft_draped_cloth *cloth, const weft_mesh *mesh, double mm_per_unit,
                        const weft_scene *scene, int paths, uint64_t seed, const weft_image *background)
{
    weft_error error = {0};
    weft_traced traced;
    const weft_trace_options options = {background->width, background->height, paths, BOUNCES, 1, seed};
    stop_on(weft_trace(cloth, mesh, mm_per_unit, scene, &options, background, NULL, &traced, &error), &error);
    weft_image_free(&traced.near);
    printf("truth of seed %d: standard error %.4f\n", (int)seed, traced.noise);
    return traced.all;
}

typedef struct cloth {
    weft_dataset *dataset;
    weft_stitch stitch;
    weft_stitch_sample *sample;
    weft_tile_mesh tile;
    weft_mesh drape;
    weft_truth_base base;
    weft_draped_cloth *draped;
} cloth;

static void open_cloth(const char *stitch, const char *dataset, cloth *c)
{
    weft_error error = {0};
    stop_on(weft_dataset_open(dataset, &c->dataset, &error), &error);
    stop_on(weft_stitch_read(stitch, &c->stitch, &error), &error);
    stop_on(weft_stitch_sample_read(stitch, BOUNCES, &c->sample, &error), &error);
    stop_on(weft_tile_mesh_create(&c->stitch, cells_of(&c->stitch, stitch), stitch, &c->tile, &error), &error);
    stop_on(weft_mesh_drape(&c->drape, &error), &error);
    stop_on(weft_truth_base_create(&c->drape, WEFT_TRUTH_REPEAT, c->stitch.width, &c->base, &error), &error);
    c->base.surface.plane_mm = (weft_real)plane_of(weft_dataset_get_layout(c->dataset));
    stop_on(weft_draped_cloth_create(&c->stitch, &c->tile, &c->base.surface, &c->draped, &error), &error);
}

/* As compare/truth/comparison.c does: texels are taken for square. */
static void set_drape(stage *s, cloth *c)
{
    weft_error error = {0};
    const weft_dataset_layout *layout = weft_dataset_get_layout(c->dataset);
    double shown = (double)layout->width / layout->height, is = c->stitch.width / c->stitch.height;
    for (int i = 0; i < c->drape.vertex_count; i++)
        c->drape.vertex[i].coordinate[1] *= (float)(is / shown);
    stop_on(weft_player_set_mesh(s->player, &c->drape, &error), &error);
}

static void compare(stage *s, cloth *c, const weft_scene *scene, int paths)
{
    weft_error error = {0};
    const faultless_btf b = {.sample = c->sample,
                             .mesh = &c->drape,
                             .mm_per_unit = c->base.mm_per_unit,
                             .plane_mm = (double)c->base.surface.plane_mm};
    weft_image background = draw_background(scene, s);
    s->truth = trace(c->draped, &c->drape, b.mm_per_unit, scene, paths, 1, &background);
    weft_image other = trace(c->draped, &c->drape, b.mm_per_unit, scene, paths, 2, &background);
    weft_image faultless = faultless_btf_draw(&b, scene, paths, &background);
    set_drape(s, c);
    stop_on(weft_player_read_surface(s->player, scene, WEFT_MODE_RAW, s->side, s->side, &s->surface, &error), &error);
    keep(s, "truth", &s->truth);
    report(s, "the truth of another seed", &other);
    report(s, "a BTF without fault", &faultless);
    report_raw(s, *scene);
    weft_image_free(&background);
    weft_image_free(&s->truth);
    free(s->surface);
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    int paths = argc > 3 ? atoi(argv[3]) : WEFT_TRUTH_DEFAULT_PATHS, skipped;
    stage s = {.side = argc > 4 ? atoi(argv[4]) : 400, .folder = argc > 5 ? argv[5] : ""};
    const weft_scene scene = make_scene();
    cloth c;
    weft_headless *headless;
    if (argc < 3 || paths < 1 || s.side < 1) {
        fprintf(stderr, "usage: bench_drape_bound STITCH DATASET.btf.h5 [PATHS [SIDE [PICTURES/]]]\n");
        return WEFT_BAD_USAGE;
    }
    open_cloth(argv[1], argv[2], &c);
    stop_on(weft_headless_create(WEFT_GL_CORE, &headless, &error), &error);
    stop_on(weft_player_create(&s.player, &error), &error);
    stop_on(weft_player_set_dataset(s.player, c.dataset, NULL, &skipped, &error), &error);
    compare(&s, &c, &scene, paths);
    weft_player_free(s.player);
    weft_headless_free(headless);
    weft_draped_cloth_free(c.draped);
    weft_truth_base_free(&c.base);
    weft_mesh_free(&c.drape);
    weft_tile_mesh_free(&c.tile);
    weft_stitch_sample_free(c.sample);
    weft_stitch_free(&c.stitch);
    weft_dataset_close(c.dataset);
    return WEFT_OK;
}
