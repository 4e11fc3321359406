#include "reflectance/bard/bard.h"

#include "btf/direction/direction.h"

#include <stdbool.h>

/* Lights nearer to the normal than this have no projection that single precision could tell. */
#define MIN_PROJECTION 1e-9

/* The view in the axes (projection of the mirror ray, across it in the surface, normal), and back. */
typedef struct projection_axes {
    weft_real x, y; /* of the projection, unit */
} projection_axes;

static weft_vec3 into_axes(projection_axes axes, weft_vec3 d)
{
    return weft_vec3_of(d.x * axes.x + d.y * axes.y, d.y * axes.x - d.x * axes.y, d.z);
}

static weft_vec3 out_of_axes(projection_axes axes, weft_vec3 d)
{
    return weft_vec3_of(d.x * axes.x - d.y * axes.y, d.x * axes.y + d.y * axes.x, d.z);
}

/* ---- The map in these axes ---- */

/* The turn from beta to beta_o, with what keeps digits at both ends of it. */
typedef struct turning {
    weft_real beta_rad, beta_o_rad, cosine, sine; /* of beta_o */
} turning;

/* Fixes 0 and pi, and sends the elevation of the light to pi/2. */
static turning turn_of(weft_real elevation_rad, weft_vec3 view)
{
    const weft_real half_pi = WEFT_PI / 2;
    weft_real across = hypot(view.y, view.z), beta = atan2(across, view.x);
    if (beta <= elevation_rad) {
        weft_real beta_o = beta * half_pi / elevation_rad;
        return (turning){beta, beta_o, cos(beta_o), sin(beta_o)};
    }
    weft_real rest = atan2(across, -view.x) * half_pi / ((weft_real)WEFT_PI - elevation_rad);
    return (turning){beta, (weft_real)WEFT_PI - rest, -cos(rest), sin(rest)};
}

static weft_vec3 turned_in_plane(const turning *turn, weft_vec3 view)
{
    weft_real across = hypot(view.y, view.z);
    if (!(across > 0))
        return weft_vec3_of(turn->cosine, 0, 0);
    return weft_vec3_of(turn->cosine, turn->sine * (view.y / across), turn->sine * (view.z / across));
}

static weft_vec3 scaled_angles(const turning *turn, weft_vec3 view)
{
    weft_real ratio = turn->beta_rad > 0 ? turn->beta_o_rad / turn->beta_rad : 1;
    weft_real elevation = ratio * atan2(view.z, hypot(view.x, view.y)), azimuth = ratio * atan2(view.y, view.x);
    return weft_vec3_of(cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation));
}

weft_bard_point weft_bard_locate(weft_bard_map map, weft_vec3 light, weft_vec3 view)
{
    const weft_real min_elevation = weft_rad_of_deg(WEFT_BARD_MIN_ELEVATION_DEG);
    weft_real length = hypot(light.x, light.y), cosine = fmax(light.z, sin(min_elevation));
    weft_bard_point point = {
        .theta_light_rad = atan2(length, light.z), .gain = 1 / (cosine * cosine), .direction = view};
    if (!(length >= (weft_real)MIN_PROJECTION))
        return point;
    projection_axes axes = {-light.x / length, -light.y / length};
    weft_vec3 local = into_axes(axes, view);
    turning turn = turn_of(fmax(atan2(light.z, length), min_elevation), local);
    point.beta_rad = turn.beta_rad;
    point.beta_o_rad = turn.beta_o_rad;
    local = map == WEFT_BARD_PRINTED ? scaled_angles(&turn, local) : turned_in_plane(&turn, local);
    point.direction = out_of_axes(axes, local);
    return point;
}

/* ---- Values ---- */

static bool is_lit_and_seen(weft_vec3 light, weft_vec3 view)
{
    return light.z > 0 && view.z > 0;
}

weft_real weft_bard_brdf(weft_bard_map map, weft_real rho_d, weft_bard_lookup *lookup, const void *table,
                         weft_vec3 light, weft_vec3 view)
{
    if (!is_lit_and_seen(light, view))
        return 0;
    weft_bard_point point = weft_bard_locate(map, light, view);
    return rho_d / (weft_real)WEFT_PI + point.gain * lookup(table, point.direction);
}

weft_bard_mix weft_bard_mix_views(weft_bard_map map, const weft_triangulation *views, weft_vec3 light, weft_vec3 view)
{
    if (!is_lit_and_seen(light, view))
        return (weft_bard_mix){.gain = 0, .at = {{0, -1, -1}, {1, 0, 0}}};
    weft_bard_point point = weft_bard_locate(map, light, view);
    return (weft_bard_mix){point.gain, weft_triangulation_lookup(views, point.direction)};
}

static weft_real mixed(weft_real a, weft_real b, weft_real share)
{
    return a + share * (b - a);
}

/* One row of the grid; `column` in [0, phi_count]. */
static weft_real row_value(const weft_bard_grid *grid, int row, weft_real column)
{
    int left = (int)column, count = grid->phi_count;
    const weft_real *value = grid->value + row * count;
    return mixed(value[left % count], value[(left + 1) % count], column - left);
}

weft_real weft_bard_grid_lookup(const void *table, weft_vec3 direction)
{
    const weft_bard_grid *grid = table;
    weft_real theta = fmin(atan2(hypot(direction.x, direction.y), direction.z), (weft_real)WEFT_PI / 2);
    weft_real turns = atan2(direction.y, direction.x) / (2 * (weft_real)WEFT_PI);
    weft_real row = theta / ((weft_real)WEFT_PI / 2) * (grid->theta_count - 1);
    weft_real column = (turns < 0 ? turns + 1 : turns) * grid->phi_count;
    int upper = (int)fmin(row, (weft_real)grid->theta_count - 2);
    return mixed(row_value(grid, upper, column), row_value(grid, upper + 1, column), row - upper);
}
