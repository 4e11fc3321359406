#include "base/numeric/statistics.h"
#include "registration/lamp/lamp.h"

#include <math.h>
#include <stdlib.h>

/* The search over directions and distances. */
enum { ring_count = 8, azimuth_count = 24 };
static const double distances_mm[] = {300, 500, 900, 1600};
static const double first_ring_deg = 4, ring_step_deg = 10;

static const double typical_mm = 700, clearance_mm = 10;

/* A listed lamp may leave this much more of the paper unexplained than the best of the search: its distance is a guess.
 */
static const double listed_misfit = 0.05;

/* The ray that a highlight reflects, from its place on the ball. False where the camera's ray misses the ball. */
static bool reflected_ray(const weft_lamp_problem *problem, const weft_lamp_evidence *evidence, int ball,
                          weft_vec3 *from, weft_vec3 *along)
{
    double place[2], radius = problem->ball_diameter_mm / 2;
    if (!evidence->highlight[ball].found || !(radius > 0))
        return false;
    weft_target_ball(problem->target, ball, place);
    weft_vec3 centre = weft_vec3_of(place[0], place[1], radius), eye = weft_pose_camera_position(&evidence->pose);
    return weft_ball_mirror(eye, evidence->highlight[ball].ray, centre, radius, from, along);
}

/* Midway between the two rays where they come closest; false where they never meet in front of the balls. */
static bool meet(const weft_vec3 from[2], const weft_vec3 along[2], weft_vec3 *place)
{
    weft_vec3 between = weft_subtract(from[1], from[0]);
    double b = weft_dot(along[0], along[1]), d = weft_dot(along[0], between), e = weft_dot(along[1], between);
    double determinant = 1 - b * b;
    if (determinant < 1e-6)
        return false;
    double s = (d - b * e) / determinant, t = (b * d - e) / determinant;
    weft_vec3 p = weft_add(from[0], weft_scale(along[0], s)), q = weft_add(from[1], weft_scale(along[1], t));
    *place = weft_scale(weft_add(p, q), 0.5);
    return s > 0 && t > 0 && place->z > 0;
}

static bool guess_from_balls(const weft_lamp_problem *problem, const weft_lamp_evidence *evidence, weft_vec3 *place)
{
    weft_vec3 from[2], along[2];
    bool seen[2];
    for (int ball = 0; ball < 2; ball++)
        seen[ball] = reflected_ray(problem, evidence, ball, &from[ball], &along[ball]);
    if (seen[0] && seen[1] && meet(from, along, place))
        return true;
    for (int ball = 0; ball < 2; ball++) {
        if (!seen[ball] || !(along[ball].z > 0.05))
            continue;
        *place = weft_add(from[ball], weft_scale(along[ball], typical_mm));
        return true;
    }
    return false;
}

/* On the line from the shadow of the pin's head through the head. */
static bool guess_from_pin(const weft_lamp_problem *problem, const weft_lamp_evidence *evidence, weft_vec3 *place)
{
    const weft_pin_shadow *shadow = &evidence->pin;
    double foot[2];
    weft_target_pin(problem->target, foot);
    if (!shadow->found || !isfinite(shadow->along_mm) || !(problem->pin_height_mm > weft_pin_head_radius_mm))
        return false;
    weft_vec3 head = weft_vec3_of(foot[0], foot[1], problem->pin_height_mm - weft_pin_head_radius_mm);
    weft_vec3 up = weft_subtract(head, weft_vec3_of(shadow->place[0], shadow->place[1], 0));
    *place = weft_add(head, weft_scale(weft_unit(up), typical_mm));
    return true;
}

/* A lamp that is told by a highlight alone may come out too low for the shadow of the pin, and for light on paper. */
static bool is_above(const weft_lamp_problem *problem, const weft_lamp_evidence *evidence, weft_vec3 place)
{
    return place.z > (evidence->pin.found ? problem->pin_height_mm : 0) + clearance_mm;
}

static double log_irradiance(weft_vec3 lamp, const double place[2])
{
    weft_vec3 to = weft_vec3_of(lamp.x - place[0], lamp.y - place[1], lamp.z);
    return log(lamp.z * weft_dot(lamp, lamp)) - 1.5 * log(weft_dot(to, to));
}

/* Median modulus of what a lamp leaves unexplained of the bare paper, after the median. */
static double misfit(const weft_lamp_problem *problem, const weft_lamp_evidence *evidence, weft_vec3 lamp,
                     double *scratch)
{
    size_t count = 0;
    for (int i = 0; i < evidence->paper.count; i++) {
        const weft_paper_sample *s = &evidence->paper.sample[i];
        if (problem->places->is_ink[s->place])
            continue;
        double light = (s->light[0] + s->light[1] + s->light[2]) / 3.0;
        scratch[count++] = log(fmax(light, 1e-6)) - log_irradiance(lamp, problem->places->place[s->place]);
    }
    double median = weft_quantile(scratch, count, 0.5);
    for (size_t i = 0; i < count; i++)
        scratch[i] = fabs(scratch[i] - median);
    return count > 0 ? weft_quantile(scratch, count, 0.5) : 0;
}

static weft_vec3 listed_place(const weft_listed_lamp *listed)
{
    return listed->is_position ? listed->light : weft_scale(listed->light, typical_mm);
}

/* By search; *is_listed where the listed lamp does nearly as well. */
static weft_vec3 guess_from_paper(const weft_lamp_problem *problem, const weft_lamp_evidence *evidence, bool *is_listed)
{
    weft_vec3 best = weft_vec3_of(0, 0, distances_mm[1]);
    double *scratch = malloc(((size_t)evidence->paper.count + 1) * sizeof *scratch), least = INFINITY;
    for (int i = 0; scratch && i < ring_count * azimuth_count * 4; i++) {
        double theta = weft_rad_of_deg(first_ring_deg + ring_step_deg * (i / 4 / azimuth_count));
        weft_angles angles = {theta, 2 * WEFT_PI * (i / 4 % azimuth_count) / azimuth_count};
        weft_vec3 lamp = weft_scale(weft_direction_of_angles(angles), distances_mm[i % 4]);
        double left = misfit(problem, evidence, lamp, scratch);
        if (left < least)
            least = left, best = lamp;
    }
    weft_vec3 listed = listed_place(&evidence->listed);
    *is_listed = scratch && evidence->listed.found && listed.z > 0 &&
                 misfit(problem, evidence, listed, scratch) < least + listed_misfit;
    free(scratch);
    return *is_listed ? listed : best;
}

void weft_lamp_guess(const weft_lamp_problem *problem, weft_lamp_solution *solution)
{
    *solution = (weft_lamp_solution){.place = solution->place,
                                     .ink = problem->target->ink_reflectance / problem->target->paper_reflectance};
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < problem->count; i++) {
        const weft_lamp_evidence *evidence = &problem->evidence[i];
        bool is_listed = false;
        weft_lamp_place *place = &solution->place[i];
        place->source = WEFT_LAMP_PAPER;
        if (problem->flash) {
            place->source = WEFT_LAMP_FLASH;
            place->position_mm = weft_pose_camera_position(&evidence->pose);
        } else if (guess_from_balls(problem, evidence, &place->position_mm) &&
                   is_above(problem, evidence, place->position_mm))
            place->source = WEFT_LAMP_BALLS;
        else if (guess_from_pin(problem, evidence, &place->position_mm))
            place->source = WEFT_LAMP_PIN;
        else {
            place->position_mm = guess_from_paper(problem, evidence, &is_listed);
            place->source = is_listed ? WEFT_LAMP_LIST : WEFT_LAMP_PAPER;
        }
    }
}

/* ---- The beam of a flash ---- */

double weft_flash_log_beam(const weft_flash *flash, const weft_pose *pose, double x, double y)
{
    const double *along[3] = {&pose->translation.x, &pose->translation.y, &pose->translation.z}, *beam = flash->beam;
    double to[3];
    for (int axis = 0; axis < 3; axis++)
        to[axis] = pose->rotation[axis][0] * x + pose->rotation[axis][1] * y + *along[axis] - flash->place_mm[axis];
    double u = to[0] / to[2], v = to[1] / to[2];
    return u * (beam[0] + beam[2] * u + beam[3] * v) + v * (beam[1] + beam[4] * v);
}
