#include "player/draw/player.h"

#include "player/draw/player_parts.h"

#include <stdlib.h>
#include <string.h>

/* SOFT_FRAMES: of a picture with soft shadows at least, at their full detail. */
enum { MAX_SIDE = 16384, MAX_SAMPLES = 64, SOFT_FRAMES = 36 };

static long least_frames(const weft_scene *scene, int width, int height)
{
    bool is_soft = scene->environment || (scene->light_count > 0 && scene->key_size_rad > 0);
    return scene->environment_reference ? WEFT_ENVIRONMENT_STRATA
           : weft_scene_has_shadows(scene) && is_soft
               ? (long)ceil(SOFT_FRAMES * weft_player_shadow_detail(width, height))
               : 1;
}

/* One place in each cell of a grid, and no two in a row or column of one that is as fine again: across a long pixel,
 * too, places are as close as frames are many. */
static weft_sampling sampling_of(long frame, int samples, long total)
{
    long column = frame % samples, row = frame / samples % samples;
    return (weft_sampling){
        .shift_x = (column + (row + 0.5) / samples) / samples - 0.5,
        .shift_y = (row + (column + 0.5) / samples) / samples - 0.5,
        .level_bias = -log2((double)samples),
        .longest_pixel = samples,
        .frame = frame,
        .neighbours_differ = total < SOFT_FRAMES,
    };
}

static weft_code add_frames(weft_player *p, const weft_scene *scene, int samples, const weft_progress *progress,
                            weft_canvas *canvas, weft_error *error)
{
    long places = (long)samples * samples, total = places;
    while (total < least_frames(scene, canvas->width, canvas->height))
        total += places;
    WEFT_TRY(weft_player_finish_ground(p, scene, canvas->width, canvas->height, error));
    for (long i = 0; i < total; i++) {
        const weft_sampling sampling = sampling_of(i, samples, total);
        weft_canvas_begin_frame(canvas);
        WEFT_TRY(weft_player_draw(p, scene, canvas->width, canvas->height, sampling, error));
        weft_canvas_end_frame(canvas);
        weft_progress_report(progress, "drawing", i + 1, total);
    }
    return weft_gl_check("summing frames", error);
}

weft_code weft_player_picture(weft_player *p, const weft_scene *scene, int width, int height, int samples,
                              const weft_progress *progress, weft_image *image, weft_error *error)
{
    int side = weft_gl_max_size() < MAX_SIDE ? weft_gl_max_size() : MAX_SIDE;
    if (width < 1 || height < 1 || width > side || height > side || samples < 1 || samples > MAX_SAMPLES)
        return weft_fail(error, WEFT_BAD_USAGE,
                         "a picture of %d x %d pixels with %d x %d samples: at most %d x %d and %d", width, height,
                         samples, samples, side, side, MAX_SAMPLES);
    weft_canvas canvas = {0};
    weft_code code = weft_canvas_create(width, height, &canvas, error);
    if (code == WEFT_OK)
        code = add_frames(p, scene, samples, progress, &canvas, error);
    if (code == WEFT_OK)
        code = weft_canvas_read(&canvas, image, error);
    weft_canvas_free(&canvas);
    return code;
}

/* ---- Surface samples ---- */

enum { PLANES = 4 };

typedef struct surface_target {
    GLuint buffer, depth, plane[PLANES];
} surface_target;

static weft_code create_target(int width, int height, surface_target *t, weft_error *error)
{
    static const GLenum attachments[PLANES] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2,
                                               GL_COLOR_ATTACHMENT3};
    for (int i = 0; i < PLANES; i++)
        WEFT_TRY(weft_gl_texture((weft_texture_format){GL_RGBA32F, GL_RGBA, GL_FLOAT}, width, height, 0, NULL,
                                 &t->plane[i], error));
    glGenRenderbuffers(1, &t->depth);
    glBindRenderbuffer(GL_RENDERBUFFER, t->depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    glGenFramebuffers(1, &t->buffer);
    glBindFramebuffer(GL_FRAMEBUFFER, t->buffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, t->depth);
    for (int i = 0; i < PLANES; i++)
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachments[i], GL_TEXTURE_2D, t->plane[i], 0);
    glDrawBuffers(PLANES, attachments);
    return weft_gl_check("making a surface buffer", error);
}

static void free_target(surface_target *t)
{
    glDeleteFramebuffers(1, &t->buffer);
    glDeleteRenderbuffers(1, &t->depth);
    glDeleteTextures(PLANES, t->plane);
}

static weft_code draw_surface(weft_player *p, const weft_scene *scene, const weft_pane *pane, GLuint target,
                              weft_error *error)
{
    GLuint program;
    WEFT_TRY(weft_player_draw_shadows(p, scene, pane->sampling.frame, error));
    WEFT_TRY(weft_player_draw_layers(p, scene, pane, 1, error));
    WEFT_TRY(weft_programs_find_geometry(&p->programs, weft_scene_has_shadows(scene), &program, error));
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glViewport(0, 0, pane->width, pane->height);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glUseProgram(program);
    weft_player_set_point(p, program, scene, pane, &p->layer[0]);
    weft_player_shade(p, pane, &p->layer[0], target);
    return WEFT_OK;
}

static void set_sample(weft_surface_sample *sample, int plane, const float value[4])
{
    switch (plane) {
    case 0:
        memcpy(sample->light, value, sizeof sample->light);
        sample->level = value[3];
        break;
    case 1:
        memcpy(sample->view, value, sizeof sample->view);
        sample->covered = value[3];
        break;
    case 2:
        sample->u = value[0];
        sample->v = value[1];
        sample->key_share = value[2];
        break;
    default:
        memcpy(sample->sides, value, sizeof sample->sides);
        break;
    }
}

static weft_code read_planes(int width, int height, weft_surface_sample *sample, weft_error *error)
{
    float(*value)[4] = malloc((size_t)width * (size_t)height * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "surface", (size_t)width * (size_t)height * sizeof *value);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    for (int plane = 0; plane < PLANES; plane++) {
        glReadBuffer(GL_COLOR_ATTACHMENT0 + (GLenum)plane);
        glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, value);
        for (int i = 0; i < width * height; i++)
            set_sample(&sample[(height - 1 - i / width) * width + i % width], plane, value[i]);
    }
    free(value);
    return weft_gl_check("reading the surface", error);
}

weft_code weft_player_read_surface(weft_player *p, const weft_scene *scene, weft_mode mode, int width, int height,
                                   weft_surface_sample **sample, weft_error *error)
{
    WEFT_TRY(weft_player_check_mode(p, mode, error));
    *sample = calloc((size_t)width * (size_t)height, sizeof **sample);
    if (!*sample)
        return weft_fail_memory(error, "surface", (size_t)width * (size_t)height * sizeof **sample);
    surface_target target = {0};
    weft_code code = create_target(width, height, &target, error);
    if (code == WEFT_OK) {
        const weft_pane pane = {.mode = mode, .width = width, .height = height};
        code = draw_surface(p, scene, &pane, target.buffer, error);
    }
    if (code == WEFT_OK)
        code = read_planes(width, height, *sample, error);
    free_target(&target);
    if (code != WEFT_OK) {
        free(*sample);
        *sample = NULL;
    }
    return code;
}
