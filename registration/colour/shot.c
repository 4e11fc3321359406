#include "registration/colour/shot.h"

#include "base/picture/colour.h"
#include "btf/session/camera_list.h"

#include <limits.h>
#include <stdlib.h>
#include <sys/stat.h>

/* Encoded values from which an integer file is clipped: as weft_photographs_defaults has it for JPEG. */
static const float clipped_encoded = 250.0f / 255;

/* Camera raw comes as floats up to 1, at which it is clipped; floats that exceed 1 are none. */
static const float clipped_raw = 0.98f;

/* ---- A file ---- */

static float clipping_of_floats(const weft_image *image)
{
    float highest = 0;
    long samples = 3L * image->width * image->height;
    for (long i = 0; i < samples; i++)
        highest = fmaxf(highest, image->pixels[i]);
    return highest <= 1 ? clipped_raw : INFINITY;
}

static weft_code read_file(const char *path, bool linear, weft_chart_shot *shot, weft_error *error)
{
    weft_image_kind kind;
    WEFT_TRY(weft_image_read(path, &shot->light, &kind, error));
    shot->has_tone = kind == WEFT_IMAGE_INTEGER && !linear;
    shot->is_scaled = kind == WEFT_IMAGE_INTEGER;
    shot->clipped_at = shot->is_scaled ? clipped_encoded : clipping_of_floats(&shot->light);
    if (!shot->has_tone)
        return WEFT_OK;
    shot->clipped_at = weft_linear_of_srgb(clipped_encoded);
    long samples = 3L * shot->light.width * shot->light.height;
    for (long i = 0; i < samples; i++)
        shot->light.pixels[i] = weft_linear_of_srgb(shot->light.pixels[i]);
    return WEFT_OK;
}

/* ---- A session ---- */

static int first_taken(const weft_session *session)
{
    int shot = 0;
    while (shot < session->shot_count && !session->record[shot].taken)
        shot++;
    return shot;
}

/* Light above black; a saturated value stays one after the division by the vignetting. */
static void develop(const weft_session *session, const uint16_t *samples, weft_image *light)
{
    int full_scale = (1 << session->bits) - 1;
    for (int y = 0; y < light->height; y++) {
        for (int x = 0; x < light->width; x++) {
            double loss = weft_camera_vignetting(&session->camera, (weft_pixel){x, y});
            for (int c = 0; c < 3; c++) {
                long at = 3L * ((long)y * light->width + x) + c;
                double value = (double)(samples[at] - session->black_level) / (full_scale - session->black_level);
                light->pixels[at] = samples[at] >= full_scale ? INFINITY : (float)(value / loss);
            }
        }
    }
}

static weft_code read_samples(const weft_session *session, int shot, weft_image *light, weft_error *error)
{
    char path[PATH_MAX];
    size_t count = (size_t)session->camera.width * (size_t)session->camera.height * 3;
    uint16_t *samples = malloc(count * sizeof *samples);
    weft_session_photograph_path(session, shot, path, sizeof path);
    weft_code code = samples ? weft_photograph_read(path, session->camera.width, session->camera.height, session->bits,
                                                    samples, error)
                             : weft_fail_memory(error, path, count * sizeof *samples);
    if (code == WEFT_OK)
        code = weft_image_create(session->camera.width, session->camera.height, light, error);
    if (code == WEFT_OK)
        develop(session, samples, light);
    free(samples);
    return code;
}

static weft_code read_session(const char *folder, weft_chart_shot *shot, weft_error *error)
{
    weft_session session;
    WEFT_TRY(weft_camera_session_open(folder, &session, error));
    int first = first_taken(&session);
    weft_code code = first < session.shot_count
                         ? read_samples(&session, first, &shot->light, error)
                         : weft_fail(error, WEFT_BAD_INPUT, "the session '%s' has no photograph yet", folder);
    weft_session_free(&session);
    shot->clipped_at = 1e6f;
    shot->is_scaled = true;
    return code;
}

weft_code weft_chart_shot_read(const char *path, bool linear, weft_chart_shot *shot, weft_error *error)
{
    struct stat found;
    *shot = (weft_chart_shot){0};
    bool is_session = stat(path, &found) == 0 && S_ISDIR(found.st_mode);
    return is_session ? read_session(path, shot, error) : read_file(path, linear, shot, error);
}
