#include "registration/axes/fit.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_ROUNDS = 25 };

/* A round that changes the scatter by less is the last. */
static const double settled = 0.02;

/* Below this, scatter is none: so that nothing is divided by 0. */
static const weft_axes_scatter least = {1e-6, 1e-4, 0.003};

typedef struct work {
    const weft_axes_shot **shot; /* [shots] */
    int shots;
    const weft_rig_poses *nominal;
    const weft_axes_fit *fit;
    weft_adjusted adjusted;
} work;

/* ---- Shots ---- */

static bool in_fold(const weft_axes_choice *choice, int index)
{
    int number = 0;
    for (int i = 0; i < index; i++)
        number += !choice->shot[i].left_out[0];
    return choice->folds > 0 && number % choice->folds == choice->fold;
}

bool weft_axes_fitted(const weft_axes_choice *choice, int index)
{
    return !choice->shot[index].left_out[0] && !in_fold(choice, index);
}

bool weft_axes_held_out(const weft_axes_choice *choice, int index)
{
    return !choice->shot[index].left_out[0] && in_fold(choice, index);
}

/* ---- Seeing ---- */

weft_pixel weft_pose_sees(const weft_camera *camera, const weft_pose *pose, double x_mm, double y_mm)
{
    const double(*r)[3] = pose->rotation;
    const weft_vec3 *t = &pose->translation;
    double z = r[2][0] * x_mm + r[2][1] * y_mm + t->z;
    double x = (r[0][0] * x_mm + r[0][1] * y_mm + t->x) / z, y = (r[1][0] * x_mm + r[1][1] * y_mm + t->y) / z;
    if (!(z > 0))
        return (weft_pixel){NAN, NAN};
    return weft_camera_distort(camera, (weft_pixel){camera->cx + camera->fx * x, camera->cy + camera->fy * y});
}

double weft_axes_squares(const weft_rig_poses *poses, const weft_axes_shot *shot)
{
    weft_pose pose = weft_rig_poses_at(poses, &shot->turns);
    double sum = 0;
    for (int i = 0; i < WEFT_AXES_POINTS; i++) {
        const weft_axes_point *p = &shot->point[i];
        weft_pixel seen = weft_pose_sees(&poses->camera, &pose, p->plate_mm[0], p->plate_mm[1]);
        double dx = seen.x - p->pixel[0], dy = seen.y - p->pixel[1];
        sum += dx * dx + dy * dy;
    }
    return isfinite(sum) ? sum : INFINITY;
}

/* Where the plate lies in a shot, beside where it lies in all. */
static weft_pose own_place(const weft_axes_scatter *s, const double *own)
{
    const weft_motion motion = {{own[0] * s->rotation_rad, own[1] * s->rotation_rad, own[2] * s->rotation_rad},
                                {own[3] * s->translation_mm, own[4] * s->translation_mm, own[5] * s->translation_mm}};
    return weft_pose_of_motion(&motion);
}

static void residual_of(const void *context, int group, const double *shared, const double *own, double *residual)
{
    const work *w = context;
    const weft_axes_shot *shot = w->shot[group];
    const weft_axes_scatter *scatter = &w->fit->scatter;
    weft_rig_poses poses = weft_rig_poses_with(w->nominal, &w->fit->terms, shared);
    weft_pose place = own_place(scatter, own), pose = weft_rig_poses_at(&poses, &shot->turns);
    pose = weft_pose_after(&pose, &place);
    for (int i = 0; i < WEFT_AXES_POINTS; i++) {
        const weft_axes_point *p = &shot->point[i];
        weft_pixel seen = weft_pose_sees(&poses.camera, &pose, p->plate_mm[0], p->plate_mm[1]);
        residual[2 * i] = (seen.x - p->pixel[0]) / scatter->point_px;
        residual[2 * i + 1] = (seen.y - p->pixel[1]) / scatter->point_px;
    }
}

/* ---- Scatter ---- */

/* Of a kind of own unknowns: by how much their standard deviation must grow. Numbers that the points tell count; those
 * that are only guessed do not (MacKay 1992). */
static double growth(const work *w, int first)
{
    double squares = 0, told = 0;
    for (int shot = 0; shot < w->shots; shot++) {
        for (int i = first; i < first + 3; i++) {
            squares += w->adjusted.own[shot][i] * w->adjusted.own[shot][i];
            told += fmax(0, 1 - w->adjusted.own_variance[shot][i]);
        }
    }
    return told > 1e-3 ? sqrt(squares / told) : 1;
}

static double told_numbers(const work *w)
{
    double told = w->fit->unknowns;
    for (int shot = 0; shot < w->shots; shot++) {
        for (int i = 0; i < WEFT_OWN_UNKNOWNS; i++)
            told += fmax(0, 1 - w->adjusted.own_variance[shot][i]);
    }
    return told;
}

static double point_growth(const work *w)
{
    double squares = 0, count = 0, residual[2 * WEFT_AXES_POINTS];
    for (int shot = 0; shot < w->shots; shot++) {
        residual_of(w, shot, w->adjusted.shared, w->adjusted.own[shot], residual);
        for (int i = 0; i < 2 * WEFT_AXES_POINTS; i++)
            squares += residual[i] * residual[i];
        count += 2 * WEFT_AXES_POINTS;
    }
    return sqrt(squares / fmax(1, count - told_numbers(w)));
}

static double grow(double *value, double by, double floor)
{
    double before = *value;
    *value = fmax(floor, before * fmin(10, fmax(0.1, by)));
    return fabs(*value / before - 1);
}

/* Returns the largest relative change. */
static double find_scatter_anew(const work *w, weft_axes_scatter *scatter)
{
    double by = point_growth(w);
    double change = grow(&scatter->rotation_rad, growth(w, 0), least.rotation_rad);
    change = fmax(change, grow(&scatter->translation_mm, growth(w, 3), least.translation_mm));
    return fmax(change, grow(&scatter->point_px, by, least.point_px));
}

/* ---- Adjusting ---- */

static weft_code adjust(work *w, weft_axes_fit *fit, weft_error *error)
{
    const weft_adjustment adjustment = {fit->unknowns, w->shots, 2 * WEFT_AXES_POINTS, w, residual_of};
    WEFT_TRY(weft_adjust(&adjustment, &w->adjusted, error));
    fit->squares = w->adjusted.squares;
    fit->poses = weft_rig_poses_with(w->nominal, &fit->terms, fit->unknown);
    return WEFT_OK;
}

static weft_code settle(work *w, bool find_scatter, weft_axes_fit *fit, weft_error *error)
{
    double change = INFINITY;
    WEFT_TRY(adjust(w, fit, error));
    for (int round = 0; find_scatter && change > settled && round < MOST_ROUNDS; round++) {
        change = find_scatter_anew(w, &fit->scatter);
        memset(w->adjusted.own, 0, (size_t)w->shots * sizeof *w->adjusted.own);
        WEFT_TRY(adjust(w, fit, error));
    }
    return WEFT_OK;
}

static void list_apart(const weft_axes_choice *choice, const work *w, double *apart)
{
    int next = 0;
    for (int i = 0; i < choice->count; i++) {
        apart[i] = 0;
        if (!weft_axes_fitted(choice, i))
            continue;
        const double *own = w->adjusted.own[next++];
        for (int k = 0; k < WEFT_OWN_UNKNOWNS; k++)
            apart[i] += own[k] * own[k] / WEFT_OWN_UNKNOWNS;
        apart[i] = sqrt(apart[i]);
    }
}

static void take_shots(const weft_axes_choice *choice, work *w)
{
    for (int i = 0; i < choice->count; i++) {
        if (weft_axes_fitted(choice, i))
            w->shot[w->shots++] = &choice->shot[i];
    }
}

weft_code weft_axes_fit_run(const weft_axes_choice *choice, const weft_rig_poses *nominal, bool find_scatter,
                            weft_axes_fit *fit, double *apart, weft_error *error)
{
    size_t count = (size_t)choice->count;
    work w = {.nominal = nominal,
              .fit = fit,
              .shot = calloc(count, sizeof *w.shot),
              .adjusted = {.shared = fit->unknown,
                           .own = calloc(count, sizeof *w.adjusted.own),
                           .covariance = fit->covariance,
                           .own_variance = calloc(count, sizeof *w.adjusted.own_variance)}};
    bool allocated = w.shot && w.adjusted.own && w.adjusted.own_variance;
    memset(fit->unknown, 0, sizeof fit->unknown);
    fit->unknowns = weft_unknown_count(&fit->terms);
    if (allocated)
        take_shots(choice, &w);
    weft_code code = allocated ? settle(&w, find_scatter, fit, error) : weft_fail_memory(error, "shots", count * 128);
    if (code == WEFT_OK && apart)
        list_apart(choice, &w, apart);
    free(w.shot);
    free(w.adjusted.own);
    free(w.adjusted.own_variance);
    return code;
}

/* ---- Terms ---- */

static const weft_term_kind of_joint[] = {WEFT_TERM_LINE, WEFT_TERM_SCALE, WEFT_TERM_UNEVEN, WEFT_TERM_WOBBLE};

enum { SHARED_TERMS = 2, TERMS_OF_JOINT = 4 };

weft_term weft_term_of(int index)
{
    if (index < SHARED_TERMS)
        return (weft_term){(weft_term_kind)index, -1};
    return (weft_term){of_joint[(index - SHARED_TERMS) % TERMS_OF_JOINT], (index - SHARED_TERMS) / TERMS_OF_JOINT};
}

int weft_term_index(weft_term_kind kind, int joint)
{
    return (int)kind < SHARED_TERMS ? (int)kind
                                    : SHARED_TERMS + TERMS_OF_JOINT * joint + (int)kind - (int)WEFT_TERM_LINE;
}

int weft_term_numbers(weft_term_kind kind)
{
    return (const int[WEFT_TERM_KINDS]){6, 4, 4, 1, 2, 4}[kind];
}

int weft_unknown_first(const weft_free_terms *terms, int index)
{
    int first = 0;
    for (int i = 0; i < index; i++)
        first += terms->free[i] ? weft_term_numbers(weft_term_of(i).kind) : 0;
    return first;
}

int weft_unknown_count(const weft_free_terms *terms)
{
    return weft_unknown_first(terms, WEFT_TERMS);
}

double weft_term_unit(const weft_camera *camera, weft_term_kind kind, int number)
{
    const double angle_rad = 0.1, place_mm = 20;
    switch (kind) {
    case WEFT_TERM_HOME:
        return number < 3 ? angle_rad : place_mm;
    case WEFT_TERM_LENS:
        return 0.03 * (number < 2 ? camera->fx : camera->width);
    case WEFT_TERM_LINE:
        return number < 2 ? angle_rad : place_mm;
    case WEFT_TERM_WOBBLE:
        return 0.01;
    default:
        return 0.02; /* scale, uneven */
    }
}

/* ---- Applying ---- */

/* The numbers of a term in their own units; 0 where it is held. */
static void numbers_of(const weft_camera *camera, const weft_free_terms *terms, int index, const double *unknown,
                       double number[WEFT_TERM_NUMBERS])
{
    weft_term term = weft_term_of(index);
    int first = weft_unknown_first(terms, index), count = terms->free[index] ? weft_term_numbers(term.kind) : 0;
    for (int i = 0; i < WEFT_TERM_NUMBERS; i++)
        number[i] = i < count ? unknown[first + i] * weft_term_unit(camera, term.kind, i) : 0;
}

static void move_home(const double number[WEFT_TERM_NUMBERS], weft_rig_poses *poses)
{
    const weft_motion motion = {{number[0], number[1], number[2]}, {number[3], number[4], number[5]}};
    weft_pose moved = weft_pose_of_motion(&motion);
    /* About the middle of the plate, so that turning and shifting are told apart. */
    weft_vec3 at = poses->home.translation;
    poses->home.translation = weft_vec3_of(0, 0, 0);
    poses->home = weft_pose_after(&moved, &poses->home);
    poses->home.translation = weft_add(poses->home.translation, at);
}

static void move_lens(const double number[WEFT_TERM_NUMBERS], weft_camera *camera)
{
    camera->fx += number[0];
    camera->fy += number[1];
    camera->cx += number[2];
    camera->cy += number[3];
}

static void move_line(const double number[WEFT_TERM_NUMBERS], weft_joint *joint)
{
    weft_vec3 e1, e2;
    weft_across(joint->direction, &e1, &e2);
    weft_vec3 lean = weft_add(weft_scale(e1, number[0]), weft_scale(e2, number[1]));
    weft_vec3 shift = weft_add(weft_scale(e1, number[2]), weft_scale(e2, number[3]));
    joint->direction = weft_unit(weft_add(joint->direction, lean));
    weft_vec3 point = weft_add(joint->point, shift);
    joint->point = weft_subtract(point, weft_scale(joint->direction, weft_dot(point, joint->direction)));
}

static void apply(weft_term term, const double number[WEFT_TERM_NUMBERS], weft_rig_poses *poses)
{
    weft_joint *joint = &poses->joint[term.joint < 0 ? 0 : term.joint];
    if (term.kind == WEFT_TERM_HOME)
        move_home(number, poses);
    else if (term.kind == WEFT_TERM_LENS)
        move_lens(number, &poses->camera);
    else if (term.kind == WEFT_TERM_LINE)
        move_line(number, joint);
    else if (term.kind == WEFT_TERM_SCALE)
        joint->scale += number[0];
    for (int i = 0; term.kind == WEFT_TERM_UNEVEN && i < 2; i++)
        joint->uneven[i] += number[i];
    for (int i = 0; term.kind == WEFT_TERM_WOBBLE && i < 4; i++)
        joint->wobble[i] += number[i];
}

weft_rig_poses weft_rig_poses_with(const weft_rig_poses *nominal, const weft_free_terms *terms, const double *unknown)
{
    weft_rig_poses poses = *nominal;
    for (int index = 0; index < WEFT_TERMS; index++) {
        double number[WEFT_TERM_NUMBERS];
        numbers_of(&nominal->camera, terms, index, unknown, number);
        if (terms->free[index])
            apply(weft_term_of(index), number, &poses);
    }
    return poses;
}
