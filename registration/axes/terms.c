#include "registration/axes/terms.h"

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
