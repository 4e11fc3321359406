#include "registration/axes/messages.h"

static const char *const term_text[WEFT_TERM_KINDS] = {"home", "lens", "line", "scale", "unevenness", "wobble"};

weft_code weft_axes_say_places(weft_lines *lines, int joint, int places, weft_error *error)
{
    if (places == 1)
        return weft_lines_add(lines, error, "%s does not turn in these shots: its line is as specified",
                              weft_joint_text[joint]);
    return weft_lines_add(lines, error, "%s stands in %d places only, 3 are needed: its line is as specified",
                          weft_joint_text[joint], places);
}

/* ---- What is held ---- */

/* Root mean squares over the numbers of a term, in its units: of its values, and of their standard errors. */
static void weigh(const weft_axes_fit *with, int index, double *value, double *error)
{
    int first = weft_unknown_first(&with->terms, index), count = weft_term_numbers(weft_term_of(index).kind);
    *value = *error = 0;
    for (int k = first; k < first + count; k++) {
        *value += with->unknown[k] * with->unknown[k] / count;
        *error += with->covariance[k * with->unknowns + k] / count;
    }
    *value = sqrt(*value);
    *error = sqrt(*error);
}

weft_code weft_axes_say_held(weft_lines *lines, const weft_axes_fit *with, const weft_camera *camera, int index,
                             weft_error *error)
{
    /* An unknown that is still half as uncertain as before was not told. */
    const double untold = 0.5;
    double value, deviation;
    weft_term term = weft_term_of(index);
    weigh(with, index, &value, &deviation);
    if (term.kind == WEFT_TERM_LENS)
        return weft_lines_add(lines, error, "The lens stays as it is: fitting it does not explain these shots better.");
    const char *joint = weft_joint_text[term.joint], *text = term_text[term.kind];
    if (deviation > untold)
        return weft_lines_add(lines, error, "These shots cannot determine the %s of %s; fixed at 0.", text, joint);
    double unit = weft_term_unit(camera, term.kind, 0);
    if (term.kind == WEFT_TERM_SCALE)
        return weft_lines_add(lines, error, "The %s of %s, %.5f +- %.5f, is no more than chance; fixed at 0.", text,
                              joint, value * unit, deviation * unit);
    return weft_lines_add(lines, error, "The %s of %s, %.3f +- %.3f degrees, is no more than chance; fixed at 0.", text,
                          joint, weft_deg_of_rad(value * unit), weft_deg_of_rad(deviation * unit));
}

/* ---- What was found ---- */

static double angle_deg(weft_vec3 a, weft_vec3 b)
{
    return weft_deg_of_rad(atan2(weft_length(weft_cross(a, b)), weft_dot(a, b)));
}

/* Between two lines that are not parallel. */
static double distance_mm(const weft_joint *a, const weft_joint *b)
{
    weft_vec3 across = weft_unit(weft_cross(a->direction, b->direction));
    return fabs(weft_dot(across, weft_subtract(a->point, b->point)));
}

static weft_code say_bearing(weft_lines *lines, const weft_joint *joint, const weft_joint_error *deviation,
                             const char *name, weft_error *error)
{
    if (deviation->scale > 0)
        WEFT_TRY(weft_lines_add(lines, error, "%s: turns %.5f +- %.5f times what its scale says", name,
                                1 + joint->scale, deviation->scale));
    if (deviation->uneven_rad > 0)
        WEFT_TRY(weft_lines_add(lines, error, "%s: its scale is uneven by %.3f +- %.3f degrees, once a turn", name,
                                weft_deg_of_rad(hypot(joint->uneven[0], joint->uneven[1])),
                                weft_deg_of_rad(deviation->uneven_rad)));
    if (deviation->wobble_rad > 0)
        WEFT_TRY(weft_lines_add(lines, error, "%s: wobbles by %.3f +- %.3f degrees", name,
                                weft_deg_of_rad(hypot(hypot(joint->wobble[0], joint->wobble[1]),
                                                      hypot(joint->wobble[2], joint->wobble[3]))),
                                weft_deg_of_rad(deviation->wobble_rad)));
    return WEFT_OK;
}

static weft_code say_joint(weft_axes_report *report, const weft_rig_poses *nominal, int k, weft_error *error)
{
    const weft_joint *joint = &report->file.poses.joint[k];
    const weft_joint_error *deviation = &report->file.error[k];
    if (deviation->direction_rad == 0)
        return WEFT_OK;
    WEFT_TRY(weft_lines_add(&report->told, error,
                            "%s: leans by %.3f +- %.3f degrees, and passes the middle of the target at %.2f +- %.2f mm",
                            weft_joint_text[k], angle_deg(joint->direction, nominal->joint[k].direction),
                            weft_deg_of_rad(deviation->direction_rad), weft_length(joint->point), deviation->point_mm));
    return say_bearing(&report->told, joint, deviation, weft_joint_text[k], error);
}

/* Of two axes these do not depend on how the target lies. */
static weft_code say_pair(weft_axes_report *report, int a, int b, weft_error *error)
{
    const weft_joint *joint = report->file.poses.joint;
    const weft_joint_error *deviation = report->file.error;
    if (deviation[a].direction_rad == 0 || deviation[b].direction_rad == 0)
        return WEFT_OK;
    return weft_lines_add(&report->told, error, "%s and %s: %.3f degrees from a right angle, %.2f mm from each other",
                          weft_joint_text[a], weft_joint_text[b],
                          fabs(90 - angle_deg(joint[a].direction, joint[b].direction)),
                          distance_mm(&joint[a], &joint[b]));
}

weft_code weft_axes_say_found(weft_axes_report *report, const weft_rig_poses *nominal, weft_error *error)
{
    for (int k = 0; k < WEFT_JOINTS; k++)
        WEFT_TRY(say_joint(report, nominal, k, error));
    WEFT_TRY(say_pair(report, WEFT_CAMERA_THETA, WEFT_CAMERA_PHI, error));
    WEFT_TRY(say_pair(report, WEFT_CAMERA_THETA, WEFT_SAMPLE_PHI, error));
    return weft_lines_add(&report->told, error, "from shot to shot: %.3f degrees, %.3f mm; a point: %.3f pixels",
                          weft_deg_of_rad(report->file.scatter_rad), report->file.scatter_mm, report->file.point_px);
}
