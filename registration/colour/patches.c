#include "registration/colour/patches.h"

#include "base/numeric/statistics.h"
#include "base/picture/colour.h"
#include "registration/colour/chart_library.h"

#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>

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

static double agreement_of(const search *s, const weft_chart_grid *grid)
{
    weft_chart_patch patch[WEFT_CHART_PATCHES];
    weft_chart_colours light;
    measure_all(s->shot, grid, patch);
    for (int i = 0; i < WEFT_CHART_PATCHES; i++)
        for (int c = 0; c < 3; c++)
            light.rgb[i][c] = patch[i].light[c];
    return weft_plain_matrix_agreement(&light, &s->reference);
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
        if (code == WEFT_SYSTEM)
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
    return *library ? WEFT_OK : weft_fail(error, WEFT_SYSTEM, "charts cannot be looked for: %s", dlerror());
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
        return weft_fail(
            error, WEFT_BAD_INPUT,
            "'%s': no colour chart is seen in it, or not all of it: lay it flat, uncovered, in even light, "
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
