#include "capture/plan.h"

#include "base/text/csv.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- Making a plan ---- */

static weft_code allocate_plan(int shot_count, weft_plan *plan, weft_error *error)
{
    *plan = (weft_plan){shot_count, calloc((size_t)shot_count, sizeof *plan->shot)};
    return plan->shot ? WEFT_OK : weft_fail_memory(error, "plan", (size_t)shot_count * sizeof *plan->shot);
}

void weft_plan_free(weft_plan *plan)
{
    free(plan->shot);
    *plan = (weft_plan){0};
}

/* All pairs, view by view. */
static weft_code plan_of_pairs(weft_angles (*angles)(int index), int count, weft_plan *plan, weft_error *error)
{
    WEFT_TRY(allocate_plan(count * count, plan, error));
    for (int i = 0; i < plan->shot_count; i++) {
        weft_angles light = angles(i % count);
        plan->shot[i] = (weft_shot){light, angles(i / count), light};
    }
    return WEFT_OK;
}

/* ---- Reading a plan ---- */

/* A shot of the file with what sorts it: the rank of its view and its row. */
typedef struct planned_shot {
    weft_shot shot;
    int view_rank, row;
} planned_shot;

static weft_code read_angles(const weft_csv *csv, int row, const int column[2], weft_angles *angles, weft_error *error)
{
    double theta_deg, phi_deg;
    WEFT_TRY(weft_csv_number(csv, row, column[0], &theta_deg, error));
    WEFT_TRY(weft_csv_number(csv, row, column[1], &phi_deg, error));
    if (!(theta_deg >= 0 && theta_deg < 90))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: theta of %g degrees is not in 0 to 90", csv->path,
                         csv->line[row], theta_deg);
    if (!(fabs(phi_deg) <= 360))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: phi of %g degrees is not in -360 to 360", csv->path,
                         csv->line[row], phi_deg);
    phi_deg += phi_deg < 0 ? 360 : phi_deg >= 360 ? -360 : 0;
    *angles = (weft_angles){weft_rad_of_deg(theta_deg), weft_rad_of_deg(phi_deg)};
    return WEFT_OK;
}

static weft_code find_columns(const weft_csv *csv, int column[4], weft_error *error)
{
    static const char *const names[4] = {"theta_light_deg", "phi_light_deg", "theta_view_deg", "phi_view_deg"};
    for (int i = 0; i < 4; i++) {
        column[i] = weft_csv_column(csv, names[i]);
        if (column[i] < 0)
            return weft_fail(error, WEFT_BAD_INPUT, "%s:1: the header has no column '%s'", csv->path, names[i]);
    }
    return WEFT_OK;
}

static weft_code read_shots(const weft_csv *csv, planned_shot *planned, weft_error *error)
{
    int column[4];
    WEFT_TRY(find_columns(csv, column, error));
    for (int row = 0; row < csv->row_count; row++) {
        weft_shot *shot = &planned[row].shot;
        WEFT_TRY(read_angles(csv, row, column, &shot->light, error));
        WEFT_TRY(read_angles(csv, row, column + 2, &shot->view, error));
        shot->light_driven = shot->light;
        planned[row].row = row;
    }
    return WEFT_OK;
}

/* Order of whole degrees: photographs are named by them. */
static int compare_angles(weft_angles a, weft_angles b)
{
    long theta_a = lround(weft_deg_of_rad(a.theta_rad)), theta_b = lround(weft_deg_of_rad(b.theta_rad));
    long phi_a = lround(weft_deg_of_rad(a.phi_rad)), phi_b = lround(weft_deg_of_rad(b.phi_rad));
    if (theta_a != theta_b)
        return theta_a < theta_b ? -1 : 1;
    return (phi_a > phi_b) - (phi_a < phi_b);
}

static int compare_views(const void *a, const void *b)
{
    const planned_shot *p = a, *q = b;
    int order = compare_angles(p->shot.view, q->shot.view);
    return order ? order : p->row - q->row;
}

static int compare_names(const void *a, const void *b)
{
    const planned_shot *p = a, *q = b;
    int order = compare_angles(p->shot.view, q->shot.view);
    if (!order)
        order = compare_angles(p->shot.light, q->shot.light);
    return order ? order : p->row - q->row;
}

static int compare_ranks(const void *a, const void *b)
{
    const planned_shot *p = a, *q = b;
    return p->view_rank != q->view_rank ? p->view_rank - q->view_rank : p->row - q->row;
}

static weft_code check_names(const weft_csv *csv, planned_shot *planned, weft_error *error)
{
    qsort(planned, (size_t)csv->row_count, sizeof *planned, compare_names);
    for (int i = 1; i < csv->row_count; i++) {
        const planned_shot *p = &planned[i - 1], *q = &planned[i];
        if (!compare_angles(p->shot.view, q->shot.view) && !compare_angles(p->shot.light, q->shot.light))
            return weft_fail(
                error, WEFT_BAD_INPUT,
                "%s:%d: this shot and the one of line %d are the same in whole degrees, which name the photographs",
                csv->path, csv->line[q->row], csv->line[p->row]);
    }
    return WEFT_OK;
}

/* Groups the shots by view; the rank of a view is the row of its first shot. */
static void sort_by_view(planned_shot *planned, int count)
{
    qsort(planned, (size_t)count, sizeof *planned, compare_views);
    for (int i = 0; i < count; i++) {
        bool same = i > 0 && compare_angles(planned[i].shot.view, planned[i - 1].shot.view) == 0;
        planned[i].view_rank = same ? planned[i - 1].view_rank : planned[i].row;
    }
    qsort(planned, (size_t)count, sizeof *planned, compare_ranks);
}

static weft_code order_shots(const weft_csv *csv, weft_plan *plan, weft_error *error)
{
    planned_shot *planned = calloc((size_t)csv->row_count, sizeof *planned);
    if (!planned)
        return weft_fail_memory(error, "plan", (size_t)csv->row_count * sizeof *planned);
    weft_code code = read_shots(csv, planned, error);
    if (code == WEFT_OK)
        code = check_names(csv, planned, error);
    if (code == WEFT_OK)
        code = allocate_plan(csv->row_count, plan, error);
    if (code == WEFT_OK) {
        sort_by_view(planned, csv->row_count);
        for (int i = 0; i < plan->shot_count; i++)
            plan->shot[i] = planned[i].shot;
    }
    free(planned);
    return code;
}

weft_code weft_plan_read(const char *name, weft_plan *plan, weft_error *error)
{
    *plan = (weft_plan){0};
    if (strcmp(name, "ubo81") == 0)
        return plan_of_pairs(weft_ubo81_angles, WEFT_UBO81_COUNT, plan, error);
    if (strcmp(name, "ubo151") == 0)
        return plan_of_pairs(weft_ubo151_angles, WEFT_UBO151_COUNT, plan, error);
    weft_csv csv;
    WEFT_TRY(weft_csv_read(name, true, &csv, error));
    weft_code code = csv.row_count > 0 ? order_shots(&csv, plan, error)
                                       : weft_fail(error, WEFT_BAD_INPUT, "%s: the plan has no shots", name);
    weft_csv_free(&csv);
    return code;
}

/* ---- Lights that step aside for the camera ---- */

static const double lowest_light_deg = 89;

/* Unit vector perpendicular to `view` that leads from it to `light`, or toward the zenith where the two coincide
 * (toward +x where the view is the zenith). */
static weft_vec3 way_aside(weft_vec3 light, weft_vec3 view)
{
    weft_vec3 goal = weft_length(weft_subtract(light, view)) > 1e-9 ? light : weft_vec3_of(0, 0, 1);
    weft_vec3 aside = weft_subtract(goal, weft_scale(view, weft_dot(goal, view)));
    if (weft_length(aside) < 1e-9)
        aside = weft_vec3_of(1, 0, 0);
    return weft_unit(aside);
}

/* The direction at `half_angle_rad` from the view, `turn_rad` round it from `aside`. */
static weft_vec3 beside(weft_vec3 view, weft_vec3 aside, double half_angle_rad, double turn_rad)
{
    weft_vec3 across = weft_cross(view, aside);
    weft_vec3 way = weft_add(weft_scale(aside, cos(turn_rad)), weft_scale(across, sin(turn_rad)));
    return weft_unit(weft_add(weft_scale(view, cos(half_angle_rad)), weft_scale(way, sin(half_angle_rad))));
}

weft_angles weft_light_beside_camera(weft_angles light, weft_angles view, double half_angle_rad)
{
    weft_vec3 toward_light = weft_direction_of_angles(light), toward_view = weft_direction_of_angles(view);
    if (weft_dot(toward_light, toward_view) < cos(half_angle_rad))
        return light;
    weft_vec3 aside = way_aside(toward_light, toward_view);
    /* The farther the turn from the direct way, the farther the direction from the light. */
    for (int step = 0; step <= 180; step++) {
        for (int side = 1; side >= -1; side -= 2) {
            weft_vec3 driven = beside(toward_view, aside, half_angle_rad, side * weft_rad_of_deg(step));
            weft_angles angles = weft_angles_of_direction(driven);
            if (driven.z > 0 && angles.theta_rad <= weft_rad_of_deg(lowest_light_deg))
                return angles;
        }
    }
    return light;
}

void weft_plan_avoid_camera(weft_plan *plan, double half_angle_rad)
{
    for (int i = 0; i < plan->shot_count; i++) {
        weft_shot *shot = &plan->shot[i];
        shot->light_driven = weft_light_beside_camera(shot->light, shot->view, half_angle_rad);
    }
}
