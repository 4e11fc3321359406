#include "tests/support/chart_picture.h"

#include "tests/support/cmocka_all.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { COLUMNS = 6, ROWS = 4, RAYS = 2 };

static const double patch_side = 0.86, board_margin = 0.35, board_reflectance = 0.035, wall_reflectance = 0.22;

/* X-Rite's list of 2016, in its order: A1 to A4 is the left column from the top. */
static const double published[COLUMNS][ROWS][3] = {
    {{37.54, 14.37, 14.92}, {62.73, 35.83, 56.5}, {28.37, 15.42, -49.8}, {95.19, -1.03, 2.93}},
    {{64.66, 19.27, 17.5}, {39.43, 10.75, -45.17}, {54.38, -39.72, 32.27}, {81.29, -0.57, 0.44}},
    {{49.32, -3.82, -22.54}, {50.57, 48.64, 16.67}, {42.43, 51.05, 28.62}, {66.89, -0.75, -0.06}},
    {{43.46, -12.74, 22.72}, {30.1, 22.54, -20.87}, {81.8, 2.67, 80.41}, {50.76, -0.13, 0.14}},
    {{54.94, 9.61, -24.79}, {71.77, -24.13, 58.19}, {50.63, 51.28, -14.12}, {35.63, -0.46, -0.48}},
    {{70.48, -32.26, -0.37}, {71.51, 18.24, 67.37}, {49.57, -29.71, -28.32}, {20.64, 0.07, -0.46}},
};

chart_picture chart_picture_usual(void)
{
    return (chart_picture){.width = 540,
                           .height = 360,
                           .corner = {{82, 56}, {450, 71}, {465, 296}, {71, 308}},
                           .camera = &spectral_cameras[0],
                           .lamp = &spectral_lamps[0],
                           .exposure = 0.8,
                           .vignetting = 0.12,
                           .noise = 0.01,
                           .stained_patch = -1,
                           .seed = 7};
}

void chart_picture_lab_d50(int patch, double lab[3])
{
    memcpy(lab, published[patch % COLUMNS][patch / COLUMNS], 3 * sizeof *lab);
}

/* ---- Geometry ---- */

/* From pixels to cells: of the map of the unit square to a quadrangle (Heckbert 1989), inverted by its adjoint. */
typedef struct cells_of_pixels {
    double m[3][3];
} cells_of_pixels;

static cells_of_pixels invert_corners(const double corner[4][2])
{
    const double *a = corner[0], *b = corner[1], *c = corner[2], *d = corner[3];
    double sx = a[0] - b[0] + c[0] - d[0], sy = a[1] - b[1] + c[1] - d[1];
    double bx = b[0] - c[0], by = b[1] - c[1], dx = d[0] - c[0], dy = d[1] - c[1], det = bx * dy - dx * by;
    double g = (sx * dy - dx * sy) / det, h = (bx * sy - sx * by) / det;
    const double f[3][3] = {{b[0] - a[0] + g * b[0], d[0] - a[0] + h * d[0], a[0]},
                            {b[1] - a[1] + g * b[1], d[1] - a[1] + h * d[1], a[1]},
                            {g, h, 1}};
    cells_of_pixels inverse;
    for (int i = 0; i < 9; i++) {
        int row = i / 3, column = i % 3, p = (column + 1) % 3, q = (column + 2) % 3, r = (row + 1) % 3,
            s = (row + 2) % 3;
        inverse.m[row][column] = (f[p][r] * f[q][s] - f[p][s] * f[q][r]) * (row == 0 ? COLUMNS : row == 1 ? ROWS : 1);
    }
    return inverse;
}

static void cell_of(const cells_of_pixels *map, double x, double y, double cell[2])
{
    double w = map->m[2][0] * x + map->m[2][1] * y + map->m[2][2];
    for (int i = 0; i < 2; i++)
        cell[i] = (map->m[i][0] * x + map->m[i][1] * y + map->m[i][2]) / w;
}

/* ---- Light ---- */

/* What the camera shows of each patch, of the leaf, and of a white diffuser, which is `exposure` at most. */
typedef struct palette {
    double patch[CHART_PICTURE_PATCHES][3], leaf[3], white[3];
} palette;

static palette mix(const chart_picture *p)
{
    palette colours;
    const double green[3] = {45, -35, 35};
    spectral_reflectance leaf = spectral_of_lab_d50(green);
    spectral_white(p->camera, p->lamp, colours.white);
    spectral_see(p->camera, p->lamp, &leaf, colours.leaf);
    for (int i = 0; i < CHART_PICTURE_PATCHES; i++) {
        double lab[3];
        chart_picture_lab_d50(i, lab);
        spectral_reflectance reflectance = spectral_of_lab_d50(lab);
        spectral_see(p->camera, p->lamp, &reflectance, colours.patch[i]);
    }
    double scale = p->exposure / fmax(colours.white[0], fmax(colours.white[1], colours.white[2]));
    for (int c = 0; c < 3; c++) {
        colours.white[c] *= scale;
        colours.leaf[c] *= scale;
        for (int i = 0; i < CHART_PICTURE_PATCHES; i++)
            colours.patch[i][c] *= scale;
    }
    return colours;
}

/* Plain reflectances stand for colourless things. */
static void colour_at(const chart_picture *p, const palette *colours, const double cell[2], double rgb[3])
{
    int column = (int)floor(cell[0]), row = (int)floor(cell[1]);
    double x = cell[0] - column - 0.5, y = cell[1] - row - 0.5;
    bool on_board = cell[0] > -board_margin && cell[0] < COLUMNS + board_margin && cell[1] > -board_margin &&
                    cell[1] < ROWS + board_margin;
    bool on_patch = column >= 0 && column < COLUMNS && row >= 0 && row < ROWS && fabs(x) < patch_side / 2 &&
                    fabs(y) < patch_side / 2;
    bool on_leaf = on_board && cell[0] > COLUMNS - p->covered_columns - 0.3 && p->covered_columns > 0;
    for (int c = 0; c < 3; c++) {
        double plain = colours->white[c] * (on_board ? board_reflectance : wall_reflectance);
        rgb[c] = on_leaf ? colours->leaf[c] : on_patch ? colours->patch[row * COLUMNS + column][c] : plain;
        if (on_patch && row * COLUMNS + column == p->stained_patch && x + y > 0)
            rgb[c] += 0.3 * colours->white[c];
    }
}

static double random_normal(unsigned *state)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) {
        *state = *state * 1664525u + 1013904223u;
        sum += (*state >> 8) / (double)(1 << 24);
    }
    return sum;
}

static double lamp_at(const chart_picture *p, int x, int y, const double cell[2])
{
    double dx = (2.0 * x / p->width - 1) / sqrt(2), dy = (2.0 * y / p->height - 1) / sqrt(2);
    return (1 - p->vignetting * (dx * dx + dy * dy)) * (1 - p->fall * (cell[0] / COLUMNS - 0.5));
}

weft_image chart_picture_render(const chart_picture *p)
{
    const cells_of_pixels map = invert_corners(p->corner);
    const palette colours = mix(p);
    weft_image image;
    unsigned state = p->seed;
    assert_int_equal(weft_image_create(p->width, p->height, &image, NULL), WEFT_OK);
    for (int i = 0; i < p->width * p->height; i++) {
        double sum[3] = {0, 0, 0};
        int x = i % p->width, y = i / p->width;
        for (int ray = 0; ray < RAYS * RAYS; ray++) {
            double cell[2], rgb[3];
            cell_of(&map, x + (ray % RAYS + 0.5) / RAYS - 0.5, y + (ray / RAYS + 0.5) / RAYS - 0.5, cell);
            colour_at(p, &colours, cell, rgb);
            for (int c = 0; c < 3; c++)
                sum[c] += rgb[c] * lamp_at(p, x, y, cell) / (RAYS * RAYS);
        }
        for (int c = 0; c < 3; c++)
            image.pixels[3 * i + c] = (float)(sum[c] + p->noise * sqrt(sum[c]) * random_normal(&state));
    }
    return image;
}

/* ---- Files ---- */

/* A power of 1/2, bent by a smooth step as the pictures of cameras are. */
static float bend(float light)
{
    float root = sqrtf(fminf(fmaxf(light, 0), 1));
    return 0.7f * root + 0.3f * root * root * (3 - 2 * root);
}

void chart_picture_write_jpeg(const chart_picture *picture, const char *path)
{
    weft_image image = chart_picture_render(picture);
    for (int i = 0; i < 3 * image.width * image.height; i++)
        image.pixels[i] = bend(image.pixels[i]);
    const weft_camera_notes notes = {"Test", "Chart", "2026:01:01 00:00:00", 1, 0.01, 4, 100, 50, 50};
    assert_int_equal(weft_snapshot_write(path, &image, &notes, NULL), WEFT_OK);
    weft_image_free(&image);
}

void chart_picture_write_exr(const chart_picture *picture, const char *path)
{
    weft_image image = chart_picture_render(picture);
    assert_int_equal(weft_image_write(path, &image, NULL, NULL), WEFT_OK);
    weft_image_free(&image);
}
