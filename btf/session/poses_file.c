#include "btf/session/poses_file.h"

#include "base/text/json_text.h"
#include "btf/session/camera_json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POSES_VERSION = 1, MAX_POSES_BYTES = 1 << 24, MAX_SIDE = 32768 };

/* No rig is larger, and no bearing worse. */
static const double largest_mm = 1e6, largest_bearing = 1, largest_coefficient = 1e6;

static const weft_json_kind kind = {"weft_poses", POSES_VERSION, "holds no poses of a rig", "holds poses"};

/* ---- Writing ---- */

static json_t *pack_list(const double *value, int count, double unit)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        weft_json_append(&list, json_real(value[i] * unit));
    return list;
}

static json_t *pack_vector(weft_vec3 v)
{
    return json_pack("[fff]", v.x, v.y, v.z);
}

static json_t *pack_joint(weft_joint_name name, const weft_joint *joint, const weft_joint_error *error)
{
    const double deg = 180 / WEFT_PI;
    json_t *errors =
        json_pack("{sf sf sf sf sf}", "direction_deg", error->direction_rad * deg, "point_mm", error->point_mm, "scale",
                  error->scale, "uneven_deg", error->uneven_rad * deg, "wobble_deg", error->wobble_rad * deg);
    return json_pack("{ss so so sf so so so}", "turns", weft_joint_text[name], "direction",
                     pack_vector(joint->direction), "point_mm", pack_vector(joint->point), "scale", joint->scale,
                     "uneven_deg", pack_list(joint->uneven, 2, deg), "wobble_deg", pack_list(joint->wobble, 4, deg),
                     "standard_error", errors);
}

static json_t *pack_joints(const weft_poses_file *file)
{
    json_t *joints = json_array();
    for (int k = 0; k < WEFT_JOINTS; k++)
        weft_json_append(&joints, pack_joint((weft_joint_name)k, &file->poses.joint[k], &file->error[k]));
    return joints;
}

static json_t *pack_home(const weft_poses_file *file)
{
    const weft_motion home = weft_motion_of_pose(&file->poses.home);
    json_t *errors = json_pack("{sf sf}", "rotation_deg", weft_deg_of_rad(file->home_rotation_rad), "translation_mm",
                               file->home_translation_mm);
    return json_pack("{so so so}", "rotation_deg", pack_list(home.rotation, 3, 180 / WEFT_PI), "translation_mm",
                     pack_list(home.translation, 3, 1), "standard_error", errors);
}

static json_t *pack_texts(const char *const *text, int count)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        weft_json_append(&list, weft_json_text(text[i], strlen(text[i])));
    return list;
}

static double sum_of_joints(const weft_poses_file *file)
{
    double sum = 0;
    for (int k = 0; k < WEFT_JOINTS; k++) {
        const weft_joint *j = &file->poses.joint[k];
        const weft_joint_error *e = &file->error[k];
        sum += j->direction.x + j->direction.y + j->direction.z + j->point.x + j->point.y + j->point.z + j->scale +
               j->uneven[0] + j->uneven[1] + j->wobble[0] + j->wobble[1] + j->wobble[2] + j->wobble[3];
        sum += e->direction_rad + e->point_mm + e->scale + e->uneven_rad + e->wobble_rad;
    }
    return sum;
}

static double sum_of_home(const weft_poses_file *file)
{
    const weft_motion home = weft_motion_of_pose(&file->poses.home);
    double sum = file->home_rotation_rad + file->home_translation_mm;
    for (int i = 0; i < 3; i++)
        sum += home.rotation[i] + home.translation[i];
    return sum;
}

static double sum_of_lens(const weft_poses_file *file)
{
    const double *vignetting = file->poses.camera.vignetting;
    double sum = vignetting[0] + vignetting[1] + vignetting[2];
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++)
        sum += weft_lens_parameter(&file->poses.camera, i) + file->lens_error[i];
    return sum;
}

/* A sum is finite where all that it is of is. JSON has nothing for what is not. */
static weft_code check_numbers(const char *path, const weft_poses_file *file, weft_error *error)
{
    const struct {
        const char *name;
        double sum;
    } part[] = {{"rms_px", file->rms_px},     {"held_out_rms_px", file->held_out_rms_px},
                {"point_px", file->point_px}, {"scatter", file->scatter_rad + file->scatter_mm},
                {"home", sum_of_home(file)},  {"joints", sum_of_joints(file)},
                {"camera", sum_of_lens(file)}};
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        if (!isfinite(part[i].sum))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' was not written: '%s' is not a finite number", path,
                             part[i].name);
    }
    return WEFT_OK;
}

weft_code weft_poses_write(const char *path, const weft_poses_file *file, const weft_lens_photograph *shot,
                           int shot_count, const char *const *undetermined, int undetermined_count, weft_error *error)
{
    WEFT_TRY(check_numbers(path, file, error));
    json_t *scatter =
        json_pack("{sf sf}", "rotation_deg", weft_deg_of_rad(file->scatter_rad), "translation_mm", file->scatter_mm);
    json_t *root = json_pack("{si so so so so so sf sf sf}", "weft_poses", POSES_VERSION, "camera",
                             weft_camera_pack(&file->poses.camera), "camera_standard_error",
                             weft_lens_pack_errors(file->lens_error), "home", pack_home(file), "joints",
                             pack_joints(file), "scatter", scatter, "point_px", file->point_px, "rms_px", file->rms_px,
                             "held_out_rms_px", file->held_out_rms_px);
    weft_lens_put_photographs(&root, shot, shot_count);
    weft_json_put(&root, "not_told", pack_texts(undetermined, undetermined_count));
    return weft_json_write(path, root, JSON_INDENT(1) | JSON_REAL_PRECISION(15), error);
}

/* ---- Reading ---- */

static bool unpack_list(json_t *json, int count, double unit, double largest, double *value)
{
    if (json_array_size(json) != (size_t)count)
        return false;
    for (int i = 0; i < count; i++) {
        json_t *item = json_array_get(json, (size_t)i);
        value[i] = json_number_value(item) * unit;
        if (!json_is_number(item) || !(fabs(value[i]) <= largest))
            return false;
    }
    return true;
}

static bool unpack_vector(json_t *json, double largest, weft_vec3 *vector)
{
    double value[3];
    if (!unpack_list(json, 3, 1, largest, value))
        return false;
    *vector = weft_vec3_of(value[0], value[1], value[2]);
    return true;
}

static bool unpack_joint_error(json_t *json, weft_joint_error *error)
{
    const double rad = WEFT_PI / 180;
    if (json &&
        json_unpack(json, "{s?F s?F s?F s?F s?F}", "direction_deg", &error->direction_rad, "point_mm", &error->point_mm,
                    "scale", &error->scale, "uneven_deg", &error->uneven_rad, "wobble_deg", &error->wobble_rad) != 0)
        return false;
    error->direction_rad *= rad;
    error->uneven_rad *= rad;
    error->wobble_rad *= rad;
    return true;
}

static bool unpack_joint(json_t *json, weft_joint_name name, weft_joint *joint, weft_joint_error *error)
{
    const double rad = WEFT_PI / 180;
    const char *turns = json_string_value(json_object_get(json, "turns"));
    json_t *scale = json_object_get(json, "scale");
    joint->scale = json_number_value(scale);
    if (!turns || strcmp(turns, weft_joint_text[name]) != 0 || !json_is_number(scale) ||
        !(fabs(joint->scale) <= largest_bearing) ||
        !unpack_vector(json_object_get(json, "direction"), 1.001, &joint->direction) ||
        !unpack_vector(json_object_get(json, "point_mm"), largest_mm, &joint->point) ||
        !unpack_list(json_object_get(json, "uneven_deg"), 2, rad, largest_bearing, joint->uneven) ||
        !unpack_list(json_object_get(json, "wobble_deg"), 4, rad, largest_bearing, joint->wobble))
        return false;
    bool unit = fabs(weft_length(joint->direction) - 1) < 1e-3;
    joint->direction = weft_unit(joint->direction);
    return unit && unpack_joint_error(json_object_get(json, "standard_error"), error);
}

static bool unpack_home(json_t *json, weft_poses_file *file)
{
    weft_motion home;
    json_t *errors = json_object_get(json, "standard_error");
    if (!unpack_list(json_object_get(json, "rotation_deg"), 3, WEFT_PI / 180, 4, home.rotation) ||
        !unpack_list(json_object_get(json, "translation_mm"), 3, 1, largest_mm, home.translation))
        return false;
    file->poses.home = weft_pose_of_motion(&home);
    if (errors && json_unpack(errors, "{s?F s?F}", "rotation_deg", &file->home_rotation_rad, "translation_mm",
                              &file->home_translation_mm) != 0)
        return false;
    file->home_rotation_rad = weft_rad_of_deg(file->home_rotation_rad);
    return true;
}

static weft_code unpack_joints(json_t *joints, const char *path, weft_poses_file *file, weft_error *error)
{
    if (json_array_size(joints) != WEFT_JOINTS)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': 'joints' is no list of %d joints", path, WEFT_JOINTS);
    for (int k = 0; k < WEFT_JOINTS; k++) {
        if (!unpack_joint(json_array_get(joints, (size_t)k), (weft_joint_name)k, &file->poses.joint[k],
                          &file->error[k]))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': the joint '%s' lacks a field, or has an invalid one", path,
                             weft_joint_text[k]);
    }
    return WEFT_OK;
}

static weft_code check_camera(const weft_camera *c, const char *path, weft_error *error)
{
    bool sound =
        c->width >= 1 && c->height >= 1 && c->width <= MAX_SIDE && c->height <= MAX_SIDE && c->fx > 0 && c->fy > 0;
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++)
        sound = sound && fabs(weft_lens_parameter(c, i)) <= largest_coefficient;
    return sound ? WEFT_OK : weft_fail(error, WEFT_BAD_INPUT, "'%s': 'camera' does not describe a lens", path);
}

static weft_code unpack_fields(json_t *root, const char *path, weft_poses_file *file, weft_error *error)
{
    json_error_t cause = {0};
    json_t *camera = json_object_get(root, "camera"), *scatter = NULL;
    if (!weft_camera_unpack(camera, &file->poses.camera, &cause) ||
        json_unpack_ex(root, &cause, 0, "{s?F s?F s?F s?o}", "rms_px", &file->rms_px, "held_out_rms_px",
                       &file->held_out_rms_px, "point_px", &file->point_px, "scatter", &scatter) != 0 ||
        (scatter && json_unpack_ex(scatter, &cause, 0, "{s?F s?F}", "rotation_deg", &file->scatter_rad,
                                   "translation_mm", &file->scatter_mm) != 0))
        return weft_json_fail(error, WEFT_BAD_INPUT, "'%s' lacks a field, or one has the wrong type: %s", path,
                              cause.text);
    file->scatter_rad = weft_rad_of_deg(file->scatter_rad);
    if (!unpack_home(json_object_get(root, "home"), file))
        return weft_json_fail(error, WEFT_BAD_INPUT, "'%s': 'home' is no pose", path);
    return check_camera(&file->poses.camera, path, error);
}

static weft_code unpack_poses(json_t *root, const char *path, weft_poses_file *file, weft_error *error)
{
    errno = 0;
    WEFT_TRY(unpack_fields(root, path, file, error));
    return unpack_joints(json_object_get(root, "joints"), path, file, error);
}

weft_code weft_poses_read(const char *path, weft_poses_file *file, weft_error *error)
{
    json_t *root = NULL;
    *file = (weft_poses_file){0};
    WEFT_TRY(weft_json_read_kind(path, MAX_POSES_BYTES, &kind, &root, error));
    weft_code code = unpack_poses(root, path, file, error);
    json_decref(root);
    return code;
}
