#include "registration/colour/patches.h"

#include "base/numeric/statistics.h"
#include "base/picture/colour.h"
#include "btf/session/camera_list.h"
#include "registration/colour/chart_library.h"
#include "registration/pose/normal_equations.h"

#include <dlfcn.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>

enum { LATTICE = 24, ORIENTATIONS = 8, BRIGHTER_PICTURES = 3 };

/* Of what a plain matrix must explain of a chart's colours, and how many of its cells must be seen as even areas. */
static const double least_agreement = 0.75, least_seen = 0.5;

/* Powers under which charts are looked for: as sRGB shows them; with their darks lifted; as light. */
static const float power[BRIGHTER_PICTURES] = {1 / 2.2f, 1 / 4.4f, 1};

typedef struct search {
    const weft_chart_shot *shot;
    weft_chart_layout layout;
    weft_chart_colours reference;
    uint8_t *picture; /* [height][width][3] for the finder */
    double agreement; /* of the best grid so far */
    bool is_mirrored;
    weft_chart_grid grid;
} search;

/* ---- Pictures for the finder ---- */

/* The light that 995 of 1000 pixels stay below. Errors: WEFT_SYSTEM. */
static weft_code bright_light(const weft_image *light, int channel, float *bright, weft_error *error)
{
    size_t pixels = (size_t)light->width * (size_t)light->height;
    float *value = malloc(pixels * sizeof *value);
    if (!value)
        return weft_fail_memory(error, "chart", pixels * sizeof *value);
    for (size_t i = 0; i < pixels; i++)
        value[i] = fminf(light->pixels[3 * i + (size_t)channel], 1e6f);
    *bright = fmaxf(weft_quantile_of_floats(value, pixels, 0.995), 1e-12f);
    free(value);
    return WEFT_OK;
}

/* Each channel from black to its bright light, so that the lamp and the camera have no colour. */
static weft_code show(const search *s, float exponent, weft_error *error)
{
    const weft_image *light = &s->shot->light;
    size_t pixels = (size_t)light->width * (size_t)light->height;
    for (int c = 0; c < 3; c++) {
        float bright;
        WEFT_TRY(bright_light(light, c, &bright, error));
        for (size_t i = 0; i < pixels; i++) {
            float value = fminf(fmaxf(light->pixels[3 * i + (size_t)c] / bright, 0), 1);
            s->picture[3 * i + (size_t)c] = (uint8_t)(255 * powf(value, exponent) + 0.5f);
        }
    }
    return WEFT_OK;
}

/* ---- Measuring ---- */

/* Mean without the lowest and the highest fifth; sorts. */
static double trimmed_mean(double *value, int count)
{
    double low = weft_quantile(value, (size_t)count, 0.2), high = weft_quantile(value, (size_t)count, 0.8), sum = 0;
    int kept = 0;
    for (int i = 0; i < count; i++) {
        if (value[i] >= low && value[i] <= high) {
            sum += value[i];
            kept++;
        }
    }
    return sum / kept;
}

/* Clipped values take part as what the file says. */
static void measure(const weft_chart_shot *shot, const weft_chart_grid *grid, int patch, weft_chart_patch *measured)
{
    double value[3][LATTICE * LATTICE], column = patch % WEFT_CHART_COLUMNS + grid->layout.left + 0.5;
    double row = patch / WEFT_CHART_COLUMNS + grid->layout.top + 0.5;
    int clipped = 0, count = 0;
    for (int i = 0; i < LATTICE * LATTICE; i++) {
        double pixel[2];
        weft_chart_grid_see(grid, column + ((i % LATTICE + 0.5) / LATTICE - 0.5) / 2,
                            row + ((i / LATTICE + 0.5) / LATTICE - 0.5) / 2, pixel);
        int x = (int)lround(fmin(fmax(pixel[0], 0), shot->light.width - 1));
        int y = (int)lround(fmin(fmax(pixel[1], 0), shot->light.height - 1));
        const float *light = shot->light.pixels + 3 * ((long)y * shot->light.width + x);
        bool is_clipped = false;
        for (int c = 0; c < 3; c++) {
            value[c][count] = (double)fminf(light[c], 1e6f);
            is_clipped = is_clipped || light[c] >= shot->clipped_at;
        }
        clipped += is_clipped;
        count++;
    }
    for (int c = 0; c < 3; c++)
        measured->light[c] = trimmed_mean(value[c], count);
    measured->clipped = (double)clipped / count;
    weft_chart_grid_see(grid, column, row, measured->pixel);
}

static void measure_all(const weft_chart_shot *shot, const weft_chart_grid *grid,
                        weft_chart_patch patch[WEFT_CHART_PATCHES])
{
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        measure(shot, grid, i, &patch[i]);
}

/* ---- Which way up ---- */

/* The share of the variance of `reference` that the 3 x 3 matrix of least squares explains by `light`, whatever tone,
 * exposure and lamp are: 1 where it explains all. 0 where it explains nothing, or the light is of fewer than three
 * colours. */
static double plain_matrix_agreement(const weft_chart_colours *light, const weft_chart_colours *reference)
{
    double left = 0, whole = 0;
    for (int c = 0; c < 3; c++) {
        weft_normal_equations equations = {0};
        double sum = 0, column[3];
        for (int i = 0; i < WEFT_CHART_PATCHES; i++) {
            const double row[WEFT_UNKNOWNS_LIMIT] = {light->rgb[i][0], light->rgb[i][1], light->rgb[i][2]};
            weft_normal_equations_add(&equations, row, reference->rgb[i][c], 1);
            sum += reference->rgb[i][c];
        }
        if (!weft_normal_equations_factor(&equations, 3))
            return 0;
        weft_normal_equations_solve(&equations, 3, column);
        whole += equations.squares - sum * sum / WEFT_CHART_PATCHES;
        left += equations.squares;
        for (int k = 0; k < 3; k++)
            left -= equations.right[k] * column[k];
    }
    return fmax(0, 1 - left / whole);
}

static double agreement_of(const search *s, const weft_chart_grid *grid)
{
    weft_chart_patch patch[WEFT_CHART_PATCHES];
    weft_chart_colours light;
    measure_all(s->shot, grid, patch);
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        for (int c = 0; c < 3; c++)
            light.rgb[i][c] = patch[i].light[c];
    return plain_matrix_agreement(&light, &s->reference);
}

/* Twice the area of the corners in their order: positive where they go round as the rows and columns of a picture do.
 */
static double turn_of(const weft_chart_sighting *sighting)
{
    double area = 0;
    for (int i = 0; i < 4; i++) {
        const double *a = sighting->corner[i], *b = sighting->corner[(i + 1) % 4];
        area += a[0] * b[1] - a[1] * b[0];
    }
    return area;
}

/* The first four begin at each corner in turn, the others go round the other way. */
static weft_code try_orientations(search *s, const weft_chart_sighting *sighting, weft_error *error)
{
    bool is_turned = turn_of(sighting) < 0;
    for (int k = 0; k < ORIENTATIONS; k++) {
        weft_chart_sighting turned;
        weft_chart_grid grid;
        for (int i = 0; i < 4; i++) {
            const double *from = sighting->corner[(k < 4 ? k + i : k + 8 - i) % 4];
            turned.corner[i][0] = from[0];
            turned.corner[i][1] = from[1];
        }
        weft_code code = weft_chart_grid_of_corners(s->layout, &turned, &grid, error);
        if (weft_class_of(code) == WEFT_SYSTEM)
            return code;
        double agreement = code == WEFT_OK ? agreement_of(s, &grid) : 0;
        if (agreement > s->agreement) {
            s->agreement = agreement;
            s->grid = grid;
            s->is_mirrored = (k >= 4) != is_turned;
        }
    }
    return WEFT_OK;
}

/* ---- The chart ---- */

static weft_code open_library(const weft_chart_library **library, weft_error *error)
{
    void *module = dlopen("weft_chart_library.so", RTLD_NOW | RTLD_LOCAL);
    *library = module ? dlsym(module, "weft_chart_library_table") : NULL;
    return *library ? WEFT_OK : weft_fail(error, WEFT_SYSTEM, "cannot search for colour charts: %s", dlerror());
}

static weft_code look(search *s, const weft_chart_library *library, float exponent, weft_error *error)
{
    weft_chart_sighting sighting[WEFT_CHART_SIGHTINGS];
    int count = 0;
    WEFT_TRY(show(s, exponent, error));
    WEFT_TRY(library->find(s->picture, s->shot->light.width, s->shot->light.height,
                           s->layout.columns > WEFT_CHART_COLUMNS, sighting, &count, error));
    for (int i = 0; i < count; i++)
        WEFT_TRY(try_orientations(s, &sighting[i], error));
    return WEFT_OK;
}

static weft_code settle(search *s, const char *path, weft_chart_patch patch[WEFT_CHART_PATCHES], weft_error *error)
{
    int seen = 0;
    if (!(s->agreement >= least_agreement))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': no complete colour chart was found in it; lay it flat, uncovered, in even light, "
                         "filling a third of the photograph or more",
                         path);
    if (s->is_mirrored)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the colour chart is mirrored", path);
    WEFT_TRY(show(s, power[0], error));
    WEFT_TRY(weft_chart_grid_refine(s->picture, s->shot->light.width, s->shot->light.height, &s->grid, &seen, error));
    if (seen < least_seen * s->layout.columns * s->layout.rows)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': only %d of the %d patches of the colour chart are seen as areas of one colour", path,
                         seen, s->layout.columns * s->layout.rows);
    measure_all(s->shot, &s->grid, patch);
    return WEFT_OK;
}

static weft_code search_chart(search *s, const char *path, weft_chart_patch patch[WEFT_CHART_PATCHES],
                              weft_error *error)
{
    const weft_chart_library *library;
    WEFT_TRY(open_library(&library, error));
    for (int i = 0; i < BRIGHTER_PICTURES && !(s->agreement >= least_agreement); i++)
        WEFT_TRY(look(s, library, power[i], error));
    return settle(s, path, patch, error);
}

weft_code weft_chart_find(const weft_chart_shot *shot, const char *path, weft_chart_kind kind,
                          weft_chart_patch patch[WEFT_CHART_PATCHES], weft_error *error)
{
    search s = {.shot = shot, .layout = weft_chart_layout_of(kind), .reference = weft_chart_reference(kind)};
    size_t bytes = (size_t)shot->light.width * (size_t)shot->light.height * 3;
    s.picture = malloc(bytes);
    if (!s.picture)
        return weft_fail_memory(error, path, bytes);
    weft_code code = search_chart(&s, path, patch, error);
    free(s.picture);
    return code;
}

/* ---- The photograph ---- */

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
