#include "base/picture/image.h"
#include "btf/direction/direction.h"
#include "btf/session/camera_list.h"
#include "tests/golden/print.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* What a session knows of its camera, or does not. */
static void print_colours(FILE *out, const weft_session *s)
{
    if (s->noise.electrons_per_value > 0)
        fprintf(out, "noise: electrons_per_value %.9g read_noise_electrons %.9g\n", s->noise.electrons_per_value,
                s->noise.read_noise_electrons);
    if (s->camera_model)
        fprintf(out, "camera_model: %s\n", s->camera_model);
    for (int i = 0; i < 3 * s->colour.terms; i++)
        fprintf(out, "%s%.9g%s", i == 0 ? "colour: " : " ", s->colour.matrix[i / s->colour.terms][i % s->colour.terms],
                i == 3 * s->colour.terms - 1 ? "\n" : "");
}

static void print_setup(FILE *out, const weft_session *s)
{
    const weft_camera *c = &s->camera;
    const weft_target *t = &s->target;
    fprintf(out, "rig: %s\nsample: %s\nrig_settings: %s\n", s->rig, s->sample, s->rig_settings);
    fprintf(out, "camera: %d x %d fx %.9g fy %.9g cx %.9g cy %.9g k1 %.9g k2 %.9g vignetting %.9g %.9g %.9g\n",
            c->width, c->height, c->fx, c->fy, c->cx, c->cy, c->k1, c->k2, c->vignetting[0], c->vignetting[1],
            c->vignetting[2]);
    fprintf(out, "distances_mm: camera %.9g light %.9g\n", s->camera_distance_mm, s->light_distance_mm);
    fprintf(out, "bits: %d black_level: %d\n", s->bits, s->black_level);
    fprintf(out, "target: opening_mm %.9g white %.9g paper %.9g ink %.9g\n", t->opening_mm, t->white_reflectance,
            t->paper_reflectance, t->ink_reflectance);
    print_colours(out, s);
}

static void print_angles(FILE *out, const char *name, weft_angles angles)
{
    fprintf(out, " %s_deg %.9g %.9g", name, weft_deg_of_rad(angles.theta_rad), weft_deg_of_rad(angles.phi_rad));
}

/* The corners, the middle, and the sum of each channel. */
static void print_pixels(FILE *out, const weft_camera *camera, const uint16_t *pixels)
{
    size_t width = (size_t)camera->width, height = (size_t)camera->height;
    const size_t at[4] = {0, width - 1, height / 2 * width + width / 2, height * width - 1};
    unsigned long sum[3] = {0};
    for (size_t i = 0; i < 3 * width * height; i++)
        sum[i % 3] += pixels[i];
    for (int i = 0; i < 4; i++)
        fprintf(out, "  pixel %zu: %d %d %d\n", at[i], pixels[3 * at[i]], pixels[3 * at[i] + 1], pixels[3 * at[i] + 2]);
    fprintf(out, "  sums: %lu %lu %lu\n", sum[0], sum[1], sum[2]);
}

static weft_code print_photograph(FILE *out, const weft_session *session, int shot, uint16_t *pixels, weft_error *error)
{
    const weft_shot_record *record = &session->record[shot];
    char path[PATH_MAX];
    weft_session_photograph_path(session, shot, path, sizeof path);
    fprintf(out, "  %s stay %d exposure_s %.9g bytes %llu crc32 %u\n", path + strlen(session->folder) + 1,
            record->viewpoint, record->exposure_s, (unsigned long long)record->bytes, record->crc32);
    WEFT_TRY(weft_photograph_read(path, session->camera.width, session->camera.height, session->bits, pixels, error));
    print_pixels(out, &session->camera, pixels);
    for (int i = 0; i < record->bracket_count; i++) {
        const weft_bracket_record *bracket = &record->bracket[i];
        fprintf(out, "  bracket %d: exposure_s %.9g bytes %llu crc32 %u\n", i, bracket->exposure_s,
                (unsigned long long)bracket->bytes, bracket->crc32);
    }
    return WEFT_OK;
}

static void print_frames(FILE *out, const weft_session *session)
{
    for (int i = 0; i < weft_session_frame_count(session); i++) {
        const weft_frame_record *record = &session->frame[i];
        char path[PATH_MAX];
        weft_session_frame_path(session, i, path, sizeof path);
        fprintf(out, "frame %d: %s exposure_s %.9g bytes %llu crc32 %u\n", i, path + strlen(session->folder) + 1,
                record->exposure_s, (unsigned long long)record->bytes, record->crc32);
    }
}

static weft_code print_shots(FILE *out, const weft_session *session, weft_error *error)
{
    uint16_t *pixels = calloc(3 * (size_t)session->camera.width * (size_t)session->camera.height, sizeof *pixels);
    weft_code code = pixels ? WEFT_OK : weft_fail_memory(error, "photograph", 0);
    for (int i = 0; i < session->shot_count && code == WEFT_OK; i++) {
        fprintf(out, "shot %d:", i);
        print_angles(out, "light", session->shot[i].light);
        print_angles(out, "view", session->shot[i].view);
        print_angles(out, "light_driven", session->shot[i].light_driven);
        fputs(session->record[i].taken ? "\n" : " not taken\n", out);
        if (session->record[i].taken)
            code = print_photograph(out, session, i, pixels, error);
    }
    free(pixels);
    return code;
}

static weft_code print_cameras(FILE *out, const weft_camera_list *list, const weft_session *sessions, int count,
                               weft_error *error)
{
    for (int i = 0; i < count; i++) {
        if (list->count > 0)
            fprintf(out, "camera '%s'\n", list->name[i]);
        print_setup(out, &sessions[i]);
        print_frames(out, &sessions[i]);
        WEFT_TRY(print_shots(out, &sessions[i], error));
    }
    return WEFT_OK;
}

weft_code print_session(const char *path, FILE *out, weft_error *error)
{
    weft_camera_list list;
    weft_session *sessions;
    int count;
    WEFT_TRY(weft_camera_list_read(path, &list, error));
    WEFT_TRY(weft_camera_sessions_open(path, &sessions, &count, error));
    weft_code code = print_cameras(out, &list, sessions, count, error);
    weft_camera_sessions_free(sessions, count);
    return code;
}
