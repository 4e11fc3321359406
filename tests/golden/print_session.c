#include "base/picture/image.h"
#include "btf/direction/direction.h"
#include "btf/session/session.h"
#include "tests/golden/print.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

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
    fprintf(out, "  %s stay %d exposure_s %.9g bytes %llu crc32 %u\n", path + strlen(session->folder) + 1, record->stay,
            record->exposure_s, (unsigned long long)record->bytes, record->crc32);
    WEFT_TRY(weft_photograph_read(path, session->camera.width, session->camera.height, session->bits, pixels, error));
    print_pixels(out, &session->camera, pixels);
    return WEFT_OK;
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

weft_code print_session(const char *path, FILE *out, weft_error *error)
{
    weft_session session;
    WEFT_TRY(weft_session_open(path, &session, error));
    print_setup(out, &session);
    weft_code code = print_shots(out, &session, error);
    weft_session_free(&session);
    return code;
}
