#include "geometry/yarn/solid_field.h"

#include <stdbool.h>

enum { MAX_JOINED = 8 };

/* Over this part of the radius the plies of a yarn flow together. */
#define PLY_BLEND 0.08
#define CORE_RADIUS 0.7 /* of the circle of the plies */

/* Where a place lies in the slab of a segment. */
typedef struct yarn_foot {
    const weft_stitch_yarn *yarn;
    const weft_yarn_strand *strand;
    weft_vec3 tangent, side, up;
    weft_real q_side, q_up; /* in the cross-section, in radii */
    weft_real phase_rad;    /* by which the plies have turned */
} yarn_foot;

static weft_vec3 mix(weft_vec3 a, weft_vec3 b, weft_real t)
{
    return weft_add(weft_scale(a, 1 - t), weft_scale(b, t));
}

/* Whether the place is in the slab of the segment. */
static bool find_foot(const weft_segment_grid *grid, const weft_near_segment *near, weft_vec3 place, yarn_foot *foot)
{
    const weft_yarn_station *a = &grid->skeleton->station[near->station], *b = a + 1;
    weft_vec3 from_a = weft_subtract(place, station_place(grid, near, near->station));
    weft_real before = weft_dot(from_a, a->tangent);
    if (before < 0)
        return false;
    weft_real after = weft_dot(weft_subtract(place, station_place(grid, near, near->station + 1)), b->tangent);
    if (after >= 0)
        return false;
    weft_real t = before / (before - after);
    const weft_yarn_strand *strand = &grid->skeleton->strand[near->strand];
    const weft_stitch_yarn *yarn = &grid->skeleton->stitch->yarn[strand->yarn];
    weft_vec3 offset = weft_subtract(from_a, weft_scale(weft_subtract(b->at, a->at), t));
    *foot = (yarn_foot){.yarn = yarn,
                        .strand = strand,
                        .tangent = mix(a->tangent, b->tangent, t),
                        .side = mix(a->side, b->side, t),
                        .up = mix(a->up, b->up, t)};
    foot->q_side = weft_dot(offset, foot->side) / yarn->radius_side;
    foot->q_up = weft_dot(offset, foot->up) / yarn->radius_up;
    foot->phase_rad =
        2 * (weft_real)WEFT_PI * strand->turns_per_mm * (a->arclength + t * (b->arclength - a->arclength));
    return true;
}

static weft_real smooth_minimum(weft_real a, weft_real b, weft_real width)
{
    weft_real overlap = width - fabs(a - b);
    return overlap > 0 ? fmin(a, b) - overlap * overlap / (4 * width) : fmin(a, b);
}

/* Radius of a ply, of n that touch each other inside the unit circle. */
static weft_real ply_radius(int plies)
{
    weft_real s = sin((weft_real)WEFT_PI / plies);
    return s / (1 + s);
}

/* Centre of the ply nearest to the foot. */
static void nearest_ply(const yarn_foot *foot, weft_real *centre_side, weft_real *centre_up)
{
    int plies = foot->yarn->plies;
    *centre_side = *centre_up = 0;
    if (plies == 1)
        return;
    weft_real spacing = 2 * (weft_real)WEFT_PI / plies;
    weft_real angle = atan2(foot->q_up, foot->q_side);
    weft_real nearest = foot->phase_rad + spacing * round((angle - foot->phase_rad) / spacing);
    weft_real circle = 1 - ply_radius(plies);
    *centre_side = circle * cos(nearest);
    *centre_up = circle * sin(nearest);
}

/* The nearest ply and its mirror image about the gap beside it are all that smin can feel near the surface. */
static weft_real section_value(const yarn_foot *foot)
{
    int plies = foot->yarn->plies;
    weft_real q = hypot(foot->q_side, foot->q_up), thin = fmin(foot->yarn->radius_side, foot->yarn->radius_up);
    if (plies == 1)
        return thin * (q - 1);
    weft_real radius = ply_radius(plies), circle = 1 - radius, spacing = 2 * (weft_real)WEFT_PI / plies;
    weft_real turned = (atan2(foot->q_up, foot->q_side) - foot->phase_rad) / spacing;
    weft_real angle = fabs(turned - round(turned)) * spacing; /* from the nearest ply, 0 .. spacing / 2 */
    weft_real nearest = hypot(q * cos(angle) - circle, q * sin(angle)) - radius;
    weft_real second = hypot(q * cos(spacing - angle) - circle, q * sin(spacing - angle)) - radius;
    weft_real value = smooth_minimum(nearest, second, PLY_BLEND);
    return thin * smooth_minimum(value, q - CORE_RADIUS * circle, PLY_BLEND);
}

/* The values of the yarns met so far, each joined over its own branches. */
typedef struct joined_yarns {
    int count;
    const weft_yarn_strand *strand[MAX_JOINED];
    weft_real value[MAX_JOINED];
} joined_yarns;

static void join(joined_yarns *joined, const weft_yarn_strand *strand, weft_real value, weft_real blend)
{
    int i = 0;
    while (i < joined->count && joined->strand[i] != strand)
        i++;
    if (i < joined->count) {
        joined->value[i] = blend > 0 ? smooth_minimum(joined->value[i], value, blend) : fmin(joined->value[i], value);
    } else if (i < MAX_JOINED) {
        joined->strand[i] = strand;
        joined->value[i] = value;
        joined->count++;
    } else {
        joined->value[i - 1] = fmin(joined->value[i - 1], value);
    }
}

weft_real weft_yarn_field_value(const weft_segment_grid *grid, weft_vec3 place)
{
    size_t count;
    const weft_near_segment *near = weft_segments_near(grid, place, &count);
    joined_yarns joined = {0};
    for (size_t i = 0; i < count; i++) {
        yarn_foot foot;
        if (find_foot(grid, &near[i], place, &foot))
            join(&joined, foot.strand, section_value(&foot), grid->skeleton->stitch->blend);
    }
    weft_real value = WEFT_YARN_FIELD_FAR;
    for (int i = 0; i < joined.count; i++)
        value = fmin(value, joined.value[i]);
    return value;
}

static weft_real value_anywhere(const weft_segment_grid *grid, weft_vec3 place)
{
    return weft_yarn_field_value(grid, weft_place_in_tile(grid->skeleton->stitch, place));
}

weft_vec3 weft_yarn_field_normal(const weft_segment_grid *grid, weft_vec3 at, weft_real step)
{
    weft_real x = value_anywhere(grid, weft_vec3_of(at.x + step, at.y, at.z)) -
                  value_anywhere(grid, weft_vec3_of(at.x - step, at.y, at.z));
    weft_real y = value_anywhere(grid, weft_vec3_of(at.x, at.y + step, at.z)) -
                  value_anywhere(grid, weft_vec3_of(at.x, at.y - step, at.z));
    weft_real z = value_anywhere(grid, weft_vec3_of(at.x, at.y, at.z + step)) -
                  value_anywhere(grid, weft_vec3_of(at.x, at.y, at.z - step));
    return weft_unit(weft_vec3_of(x, y, z));
}

/* Velocity, per mm along the yarn, of the turn about a centre of the cross-section. */
static weft_vec3 turn_velocity(const yarn_foot *foot, weft_real turns_per_mm, weft_real q_side, weft_real q_up)
{
    weft_real rate = 2 * (weft_real)WEFT_PI * turns_per_mm;
    return weft_add(weft_scale(foot->side, -rate * q_up * foot->yarn->radius_side),
                    weft_scale(foot->up, rate * q_side * foot->yarn->radius_up));
}

static weft_vec3 fibre_direction(const yarn_foot *foot)
{
    weft_real centre_side, centre_up;
    nearest_ply(foot, &centre_side, &centre_up);
    weft_vec3 of_plies = {0};
    if (foot->yarn->plies > 1)
        of_plies = turn_velocity(foot, foot->strand->turns_per_mm, foot->q_side, foot->q_up);
    weft_vec3 of_fibres =
        turn_velocity(foot, foot->yarn->fibre_twist, foot->q_side - centre_side, foot->q_up - centre_up);
    return weft_unit(weft_add(foot->tangent, weft_add(of_plies, of_fibres)));
}

int weft_yarn_field_fibre(const weft_segment_grid *grid, weft_vec3 place, weft_vec3 *tangent)
{
    size_t count;
    const weft_near_segment *near = weft_segments_near(grid, place, &count);
    weft_real least = INFINITY;
    int yarn = -1;
    for (size_t i = 0; i < count; i++) {
        yarn_foot foot;
        if (!find_foot(grid, &near[i], place, &foot))
            continue;
        weft_real value = section_value(&foot);
        if (value < least) {
            least = value;
            yarn = foot.strand->yarn;
            *tangent = fibre_direction(&foot);
        }
    }
    return yarn;
}
