#include "player/scene/environment.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST_WIDTH = 1024, STRATUM_CUTS = 11 };

/* Sums over the pixels above and left of a corner: power, and power times direction. [height + 1][width + 1] */
enum { RED, GREEN, BLUE, WEIGHT, X, Y, Z, SUMS };

typedef double sums[SUMS];

typedef struct map {
    int width, height;
    sums *above;
} map;

typedef struct region {
    int left, right, top, bottom; /* pixels, right and bottom beyond the last */
} region;

static weft_vec3 direction_at(double column, double row, int width, int height)
{
    double phi_rad = 2 * WEFT_PI * (0.75 - column / width), theta_rad = WEFT_PI * row / height;
    return weft_vec3_of((weft_real)(sin(theta_rad) * cos(phi_rad)), (weft_real)(sin(theta_rad) * sin(phi_rad)),
                        (weft_real)cos(theta_rad));
}

/* A limit that leaves room for sums over the sphere in single precision. */
static const double largest_radiance = 1e30;

static double positive(float value)
{
    return value > 0 && isfinite(value) ? fmin((double)value, largest_radiance) : 0;
}

/* The mean of the pixels that fall into one of the map: those of rows with more of the sphere count more, but within a
 * pixel of the map that does not matter. */
static void mean_radiance(const weft_image *image, const map *m, int column, int row, double radiance[3])
{
    int x0 = (int)((long)column * image->width / m->width), x1 = (int)((long)(column + 1) * image->width / m->width);
    int y0 = (int)((long)row * image->height / m->height), y1 = (int)((long)(row + 1) * image->height / m->height);
    for (int c = 0; c < 3; c++)
        radiance[c] = 0;
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            for (int c = 0; c < 3; c++)
                radiance[c] += positive(image->pixels[3 * ((size_t)y * (size_t)image->width + (size_t)x) + (size_t)c]);
        }
    }
    for (int c = 0; c < 3; c++)
        radiance[c] /= (double)(x1 - x0) * (y1 - y0);
}

static void set_pixel(const map *m, const double radiance[3], int column, int row, sums value)
{
    double solid_angle =
        2 * WEFT_PI / m->width * (cos(WEFT_PI * row / m->height) - cos(WEFT_PI * (row + 1) / m->height));
    weft_vec3 direction = direction_at(column + 0.5, row + 0.5, m->width, m->height);
    for (int c = 0; c < 3; c++)
        value[c] = radiance[c] * solid_angle / WEFT_PI;
    double weight = value[RED] + value[GREEN] + value[BLUE];
    value[WEIGHT] = weight;
    value[X] = weight * (double)direction.x;
    value[Y] = weight * (double)direction.y;
    value[Z] = weight * (double)direction.z;
}

static void fill(const weft_image *image, map *m)
{
    int pitch = m->width + 1;
    for (int row = 0; row < m->height; row++) {
        sums along = {0};
        for (int column = 0; column < m->width; column++) {
            double radiance[3];
            sums value;
            mean_radiance(image, m, column, row, radiance);
            set_pixel(m, radiance, column, row, value);
            const double *above = m->above[(size_t)row * (size_t)pitch + (size_t)column + 1];
            double *here = m->above[(size_t)(row + 1) * (size_t)pitch + (size_t)column + 1];
            for (int i = 0; i < SUMS; i++) {
                along[i] += value[i];
                here[i] = above[i] + along[i];
            }
        }
    }
}

static double sum_of(const map *m, const region *r, int quantity)
{
    size_t pitch = (size_t)m->width + 1;
    sums *top = m->above + (size_t)r->top * pitch, *bottom = m->above + (size_t)r->bottom * pitch;
    return bottom[r->right][quantity] - bottom[r->left][quantity] - top[r->right][quantity] + top[r->left][quantity];
}

static bool is_pixel(const region *r)
{
    return r->right - r->left == 1 && r->bottom - r->top == 1;
}

/* Of more than a pixel: across the longer side on the sphere, where the two halves weigh nearly the same. */
static void cut(const map *m, const region *whole, region *first, region *second)
{
    *first = *second = *whole;
    int width = whole->right - whole->left, height = whole->bottom - whole->top;
    double middle = WEFT_PI * (whole->top + whole->bottom) / (2.0 * m->height);
    bool upright = height == 1 || (width > 1 && 2.0 * width / m->width * sin(middle) >= (double)height / m->height);
    int low = (upright ? whole->left : whole->top) + 1, high = (upright ? whole->right : whole->bottom) - 1;
    double half = sum_of(m, whole, WEIGHT) / 2;
    while (low < high) {
        int at = (low + high) / 2;
        *(upright ? &first->right : &first->bottom) = at;
        if (sum_of(m, first, WEIGHT) < half)
            low = at + 1;
        else
            high = at;
    }
    *(upright ? &first->right : &first->bottom) = low;
    *(upright ? &second->left : &second->top) = low;
}

/* ---- Regions ---- */

/* Power times the variance of its direction: weight - |sum of weight x direction|^2 / weight. */
static double spread(const map *m, const region *r)
{
    double weight = sum_of(m, r, WEIGHT), x = sum_of(m, r, X), y = sum_of(m, r, Y), z = sum_of(m, r, Z);
    return weight > 0 && !is_pixel(r) ? weight - (x * x + y * y + z * z) / weight : 0;
}

/* Returns how many there are: fewer than `most` where few pixels are lit. */
static int find_regions(const map *m, int most, region regions[WEFT_ENVIRONMENT_REGIONS])
{
    int count = 1;
    regions[0] = (region){0, m->width, 0, m->height};
    while (count < most) {
        int widest = 0;
        for (int i = 1; i < count; i++) {
            if (spread(m, &regions[i]) > spread(m, &regions[widest]))
                widest = i;
        }
        if (!(spread(m, &regions[widest]) > 0))
            break;
        const region whole = regions[widest];
        cut(m, &whole, &regions[widest], &regions[count++]);
    }
    return count;
}

/* ---- Lights ---- */

static weft_distant_light light_of(const double sum[SUMS], double scale)
{
    weft_vec3 centroid = weft_vec3_of((weft_real)sum[X], (weft_real)sum[Y], (weft_real)sum[Z]);
    bool is_dark = !((double)weft_dot(centroid, centroid) > 0);
    weft_distant_light light = {.direction = is_dark ? weft_vec3_of(0, 0, 1) : weft_unit(centroid)};
    for (int c = 0; c < 3; c++)
        light.irradiance[c] = (float)(scale * fmax(sum[c], 0));
    return light;
}

/* Reversed bits: neighbours become far apart in time. Without more, the first frames would
 * all take a corner of the region and of each of its quarters; so two cuts in four, which are one across and one
 * upright, count from their other end: the stratum then lies a third from the edges. */
int weft_environment_frame_of_stratum(int stratum)
{
    const int other_end = 0x19;
    int frame = 0;
    for (int bit = 1; bit < WEFT_ENVIRONMENT_STRATA; bit <<= 1)
        frame = frame << 1 | (((stratum ^ other_end) & bit) != 0);
    return frame;
}

/* Parts being filled one after the other, each up to its share of the region's weight. */
typedef struct filling {
    weft_environment *environment;
    int region, stratum;
    double capacity; /* of a stratum */
    sums sum;        /* of the stratum being filled */
} filling;

static void finish_stratum(filling *f)
{
    f->environment->stratum[weft_environment_frame_of_stratum(f->stratum)][f->region] =
        light_of(f->sum, WEFT_ENVIRONMENT_STRATA);
    memset(f->sum, 0, sizeof f->sum);
    f->stratum++;
}

/* A piece goes into as many strata as it fills. */
static void add_piece(filling *f, const double piece[SUMS])
{
    double used = 0;
    while (used < 1 && piece[WEIGHT] > 0) {
        double room = (f->capacity - f->sum[WEIGHT]) / piece[WEIGHT];
        bool is_last = f->stratum == WEFT_ENVIRONMENT_STRATA - 1;
        double share = is_last || room > 1 - used ? 1 - used : room;
        for (int i = 0; i < SUMS; i++)
            f->sum[i] += share * piece[i];
        if (share < 1 - used)
            finish_stratum(f);
        used += share;
    }
}

static void add_pieces(const map *m, const region *r, int depth, filling *f)
{
    if (depth == STRATUM_CUTS || is_pixel(r) || !(sum_of(m, r, WEIGHT) > 0)) {
        sums piece;
        for (int i = 0; i < SUMS; i++)
            piece[i] = sum_of(m, r, i);
        add_piece(f, piece);
        return;
    }
    region first, second;
    cut(m, r, &first, &second);
    add_pieces(m, &first, depth + 1, f);
    add_pieces(m, &second, depth + 1, f);
}

static void set_region(const map *m, const region *r, int number, weft_environment *environment)
{
    sums sum;
    for (int i = 0; i < SUMS; i++)
        sum[i] = sum_of(m, r, i);
    environment->region[number] = light_of(sum, 1);
    filling f = {.environment = environment, .region = number, .capacity = sum[WEIGHT] / WEFT_ENVIRONMENT_STRATA};
    add_pieces(m, r, 0, &f);
    while (f.stratum < WEFT_ENVIRONMENT_STRATA)
        finish_stratum(&f);
}

static void set_lights(const map *m, int most, weft_environment *environment)
{
    region regions[WEFT_ENVIRONMENT_REGIONS];
    int count = find_regions(m, most, regions);
    *environment = (weft_environment){.region_count = most};
    for (int i = 0; i < most; i++) {
        if (i < count)
            set_region(m, &regions[i], i, environment);
        else
            environment->region[i].direction = weft_vec3_of(0, 0, 1);
        for (int stratum = 0; i >= count && stratum < WEFT_ENVIRONMENT_STRATA; stratum++)
            environment->stratum[stratum][i].direction = weft_vec3_of(0, 0, 1);
    }
}

weft_code weft_environment_of_image(const weft_image *image, int region_count, weft_environment *environment,
                                    weft_error *error)
{
    if (image->width != 2 * image->height)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "an environment map by longitude and latitude is twice as wide as high, not %d x %d",
                         image->width, image->height);
    map m = {.width = image->width < LARGEST_WIDTH ? image->width : LARGEST_WIDTH};
    m.height = m.width / 2;
    size_t corners = ((size_t)m.width + 1) * ((size_t)m.height + 1);
    m.above = calloc(corners, sizeof *m.above);
    if (!m.above)
        return weft_fail_memory(error, "environment map", corners * sizeof *m.above);
    fill(image, &m);
    const region sphere = {0, m.width, 0, m.height};
    bool lit = sum_of(&m, &sphere, WEIGHT) > 0;
    if (lit)
        set_lights(&m, region_count, environment);
    free(m.above);
    return lit ? WEFT_OK : weft_fail(error, WEFT_BAD_INPUT, "the environment map is black");
}
