#include "edit/prune/visibility_bounds.h"

#include "btf/direction/square_map.h"

#include <string.h>

/* Views are held above the horizon at least so high (player/draw/shaders/surface.glsl). */
static const double lowest_view_z = 0.02;
/* Of places in a square, and of texture coordinates: single precision where the pixel computes them. */
static const double place_margin = 1e-4, texel_margin = 0.02;

/* ---- Texels ---- */

static void mark_row(weft_visibility *visibility, int k, int row, int first, int count)
{
    int width = visibility->width[k];
    uint8_t *texel = visibility->texel[k] + (size_t)row * (size_t)width;
    for (int i = 0; i < count; i++) {
        uint8_t *at = texel + (first + i) % width;
        visibility->texel_count[k] += !*at;
        *at = 1;
    }
}

/* First texel and number of texels of a repeated row that interpolation reads between two places. */
static void texels_between(double low, double high, int count, int *first, int *number)
{
    double from = floor(low * count - 0.5 - texel_margin), to = floor(high * count - 0.5 + texel_margin) + 1;
    *number = to - from + 1 < count ? (int)(to - from) + 1 : count;
    *first = (int)(from - floor(from / count) * count);
}

void weft_visibility_mark_texels(weft_visibility *visibility, const weft_visibility_box *box, int first_level,
                                 int last_level)
{
    for (int k = first_level; k <= last_level; k++) {
        if (visibility->texel_count[k] == (long)visibility->width[k] * visibility->height[k])
            continue;
        int column, columns, row, rows;
        double u_low = box->low[0] - box->border[0], u_high = box->high[0] + box->border[0];
        double v_low = box->low[1] - box->border[1], v_high = box->high[1] + box->border[1];
        texels_between(u_low, u_high, visibility->width[k], &column, &columns);
        texels_between(-v_high, -v_low, visibility->height[k], &row, &rows);
        for (int i = 0; i < rows; i++)
            mark_row(visibility, k, (row + i) % visibility->height[k], column, columns);
    }
}

/* ---- Directions ---- */

/* A box of the square of directions. */
typedef struct cell_box {
    int column[2], row[2];
} cell_box;

static int cell_of(double place, int side)
{
    int cell = (int)floor(place * side);
    return cell < 0 ? 0 : cell > side - 1 ? side - 1 : cell;
}

/* The square is a conformal map: at the angle theta from the normal lengths grow by 1 / (4 cos^2(theta / 2)), and a cap
 * lies in a box of its largest scale. Of a cap that reaches far below the horizon nothing is said. */
static cell_box box_of(const weft_direction_cap *cap, int side)
{
    double theta = acos(weft_clamp(cap->axis.z, -1, 1)) + cap->angle_rad;
    if (theta > 2.6)
        return (cell_box){{0, side - 1}, {0, side - 1}};
    double cosine = cos(theta / 2), visibility = cap->angle_rad / (4 * cosine * cosine) + place_margin;
    weft_place place = weft_place_of_direction(cap->axis);
    return (cell_box){{cell_of(place.x - visibility, side), cell_of(place.x + visibility, side)},
                      {cell_of(place.y - visibility, side), cell_of(place.y + visibility, side)}};
}

static void mark_box(uint8_t *map, int side, cell_box box)
{
    for (int row = box.row[0]; row <= box.row[1]; row++)
        memset(map + row * side + box.column[0], 1, (size_t)box.column[1] - (size_t)box.column[0] + 1);
}

/* Views below the horizon are lifted onto it, which moves two of them apart where they lie far below. */
static weft_direction_cap held_above(const weft_direction_cap *view)
{
    double lowest = acos(weft_clamp(view->axis.z, -1, 1)) + view->angle_rad;
    if (cos(fmin(lowest, WEFT_PI)) >= lowest_view_z)
        return *view;
    double spread = lowest < WEFT_PI ? fmax(sin(lowest), 0.05) : 0.05;
    weft_direction_cap held = {weft_unit(weft_vec3_of(view->axis.x, view->axis.y, fmax(view->axis.z, lowest_view_z))),
                               view->angle_rad / spread};
    return held;
}

static bool is_above_horizon(const weft_direction_cap *light)
{
    return asin(weft_clamp(light->axis.z, -1, 1)) + light->angle_rad > 0;
}

/* Products of coordinates differ from those of the axes by no more than both angles. */
static void mark_products(weft_visibility *visibility, const weft_direction_cap *view, const weft_direction_cap *light)
{
    const double l[3] = {light->axis.x, light->axis.y, light->axis.z};
    const double v[3] = {view->axis.x, view->axis.y, view->axis.z};
    double slack = light->angle_rad + view->angle_rad;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double *range = visibility->product[i][j], product = l[i] * v[j];
            range[0] = fmax(fmin(range[0], product - slack), -1);
            range[1] = fmin(fmax(range[1], product + slack), 1);
        }
}

static void mark_lights(weft_visibility *visibility, cell_box views, cell_box lights)
{
    for (int row = views.row[0]; row <= views.row[1]; row++)
        for (int column = views.column[0]; column <= views.column[1]; column++)
            mark_box(visibility->pair + (size_t)(row * WEFT_VISIBILITY_PAIR_SIDE + column) * WEFT_VISIBILITY_PAIR_CELLS,
                     WEFT_VISIBILITY_PAIR_SIDE, lights);
}

void weft_visibility_mark_pair(weft_visibility *visibility, const weft_direction_cap *view,
                               const weft_direction_cap *light)
{
    const weft_direction_cap held = held_above(view);
    mark_box(visibility->view, WEFT_VISIBILITY_SIDE, box_of(&held, WEFT_VISIBILITY_SIDE));
    if (!is_above_horizon(light))
        return;
    mark_box(visibility->light, WEFT_VISIBILITY_SIDE, box_of(light, WEFT_VISIBILITY_SIDE));
    mark_lights(visibility, box_of(&held, WEFT_VISIBILITY_PAIR_SIDE), box_of(light, WEFT_VISIBILITY_PAIR_SIDE));
    mark_products(visibility, &held, light);
}

void weft_visibility_mark_view(weft_visibility *visibility, const weft_direction_cap *view)
{
    const weft_direction_cap held = held_above(view);
    mark_box(visibility->view, WEFT_VISIBILITY_SIDE, box_of(&held, WEFT_VISIBILITY_SIDE));
}

_Static_assert(WEFT_VISIBILITY_SIDE == 2 * WEFT_VISIBILITY_PAIR_SIDE, "four cells of one square are one of the other");

void weft_visibility_light_all(weft_visibility *visibility)
{
    memset(visibility->light, 1, sizeof visibility->light);
    for (int i = 0; i < WEFT_VISIBILITY_SIDE * WEFT_VISIBILITY_SIDE; i++) {
        int cell = i / WEFT_VISIBILITY_SIDE / 2 * WEFT_VISIBILITY_PAIR_SIDE + i % WEFT_VISIBILITY_SIDE / 2;
        if (visibility->view[i])
            memset(visibility->pair + (size_t)cell * WEFT_VISIBILITY_PAIR_CELLS, 1, WEFT_VISIBILITY_PAIR_CELLS);
    }
}
