#include "base/integers.h"
#include "base/text/json_text.h"
#include "btf/dataset/hdf5.h"

#include <stdbool.h>

enum { MAX_SIDE = 65536, MAX_IMAGES = 1 << 24 };

const char *const weft_values_name[2] = {"reflectance_cosine", "reflectance"};
const char *const weft_distance_name[2] = {"far", "near"};
const char *const weft_image_figure_name[WEFT_IMAGE_FIGURES] = {
    [WEFT_IMAGE_WEIGHT] = "weight",
    [WEFT_IMAGE_VIEW_ERROR] = "view_standard_error_deg",
    [WEFT_IMAGE_LIGHT_ERROR] = "light_standard_error_deg",
    [WEFT_IMAGE_VALUE_ERROR] = "value_relative_standard_error",
};

static weft_code check_count(const char *path, const char *what, int count, int most, weft_code code, weft_error *error)
{
    if (count < 1 || count > most)
        return weft_fail(error, code, "'%s': %s is %d, must be 1 to %d", path, what, count, most);
    return WEFT_OK;
}

/* Slopes through heights are to stay numbers in single precision. */
static weft_code check_pitch_of_depth(const weft_dataset_layout *layout, const char *path, weft_code code,
                                      weft_error *error)
{
    if (layout->texel_pitch_mm >= 1e-6 && layout->texel_pitch_mm < 1e9)
        return WEFT_OK;
    return weft_fail(error, code, "'%s': texel_pitch_mm is %g, must be 1e-6 to 1e9 for a dataset with heights", path,
                     layout->texel_pitch_mm);
}

/* Optional numbers: 0 stands for "not known". */
static weft_code check_numbers(const weft_dataset_layout *layout, const char *path, weft_code code, weft_error *error)
{
    const double most_aspect = 1000;
    double aspect = weft_dataset_texel_aspect(layout);
    if (!(layout->texel_aspect >= 0) || aspect > most_aspect || aspect < 1 / most_aspect)
        return weft_fail(error, code, "'%s': texel_aspect is %g, must be %g to %g", path, layout->texel_aspect,
                         1 / most_aspect, most_aspect);
    double side = layout->texel_pitch_mm * weft_larger(layout->width, layout->height);
    if (!(fabs(layout->plane_mm) <= side * sqrt(most_aspect)))
        return weft_fail(error, code, "'%s': plane_mm is %g, further from the texels than the material is wide", path,
                         layout->plane_mm);
    return layout->plane_mm == 0 ? WEFT_OK : check_pitch_of_depth(layout, path, code, error);
}

weft_code weft_dataset_layout_check_counts(const weft_dataset_layout *layout, const char *path, weft_code code,
                                           weft_error *error)
{
    WEFT_TRY(check_count(path, "width", layout->width, MAX_SIDE, code, error));
    WEFT_TRY(check_count(path, "height", layout->height, MAX_SIDE, code, error));
    WEFT_TRY(check_count(path, "number of images", layout->image_count, MAX_IMAGES, code, error));
    WEFT_TRY(check_count(path, "number of views", layout->view_count, MAX_IMAGES, code, error));
    if (!(layout->texel_pitch_mm > 0) || !isfinite(layout->texel_pitch_mm))
        return weft_fail(error, code, "'%s': texel_pitch_mm is %g, must be positive", path, layout->texel_pitch_mm);
    return check_numbers(layout, path, code, error);
}

static bool is_place(weft_distance distance, weft_vec3 place)
{
    double length = weft_length(place);
    if (!isfinite(length))
        return false;
    return distance == WEFT_NEAR ? place.z > 0 : fabs(length - 1) < 1e-3 && place.z >= -1e-6;
}

static weft_code check_places(const weft_dataset_layout *layout, const char *what, const weft_vec3 *place, int count,
                              const char *path, weft_code code, weft_error *error)
{
    for (int i = 0; i < count; i++) {
        if (!is_place(layout->distance, place[i]))
            return weft_fail(error, code, "'%s': %s %d (%g, %g, %g) is no %s above the surface", path, what, i,
                             place[i].x, place[i].y, place[i].z,
                             layout->distance == WEFT_NEAR ? "position" : "unit direction");
    }
    return WEFT_OK;
}

static bool is_frame(const float frame[6])
{
    weft_vec3 normal = weft_vec3_of(frame[0], frame[1], frame[2]), tangent = weft_vec3_of(frame[3], frame[4], frame[5]);
    return fabs(weft_length(normal) - 1) < 1e-3 && fabs(weft_length(tangent) - 1) < 1e-3 &&
           fabs(weft_dot(normal, tangent)) < 1e-3 && normal.z >= -1e-6;
}

weft_code weft_dataset_frames_check(const float *frames, size_t count, int row, int width, const char *path,
                                    weft_code code, weft_error *error)
{
    for (size_t i = 0; i < count; i++) {
        const float *f = frames + 6 * i;
        if (!is_frame(f))
            return weft_fail(error, code,
                             "'%s': frame of texel (%d, %d) is no normal above the surface with a tangent: (%g, %g, "
                             "%g), (%g, %g, %g)",
                             path, (int)(i % (size_t)width), row + (int)(i / (size_t)width), f[0], f[1], f[2], f[3],
                             f[4], f[5]);
    }
    return WEFT_OK;
}

static bool is_multiple(int places, int texels)
{
    return places >= texels && places % texels == 0 && places / texels <= WEFT_MOST_HEIGHTS;
}

weft_code weft_dataset_heights_check(const weft_dataset_layout *layout, const weft_dataset_heights *heights,
                                     const char *path, weft_code code, weft_error *error)
{
    double most = 2 * layout->texel_pitch_mm * weft_larger(layout->width, layout->height);
    WEFT_TRY(check_pitch_of_depth(layout, path, code, error));
    if (!is_multiple(heights->width, layout->width) || !is_multiple(heights->height, layout->height))
        return weft_fail(error, code, "'%s': %d x %d heights, must be 1 to %d times the %d x %d texels", path,
                         heights->width, heights->height, WEFT_MOST_HEIGHTS, layout->width, layout->height);
    if (heights->level_count < 1)
        return weft_fail(error, code, "'%s': height_levels is not 1 or more", path);
    for (long i = 0; heights->value && i < (long)heights->width * heights->height; i++)
        if (!(fabsf(heights->value[i]) <= (float)most))
            return weft_fail(error, code, "'%s': height (%ld, %ld) is %g mm, must be within %g", path,
                             i % heights->width, i / heights->width, heights->value[i], most);
    return WEFT_OK;
}

weft_code weft_dataset_figure_check(const weft_dataset_layout *layout, weft_image_figure figure, const char *path,
                                    weft_code code, weft_error *error)
{
    const double *value = layout->figure[figure];
    double most = 0;
    for (int i = 0; value && i < layout->image_count; i++) {
        if (!(value[i] >= 0) || !isfinite(value[i]))
            return weft_fail(error, code, "'%s': %s of image %d is %g, must be finite and not negative", path,
                             weft_image_figure_name[figure], i, value[i]);
        most = fmax(most, value[i]);
    }
    if (value && figure == WEFT_IMAGE_WEIGHT && !(most > 0))
        return weft_fail(error, code, "'%s': the weight of every image is 0", path);
    return WEFT_OK;
}

weft_code weft_dataset_provenance_check(const char *text, const char *path, weft_code code, weft_error *error)
{
    json_error_t where;
    errno = 0;
    json_t *object = text ? json_loads(text, 0, &where) : NULL;
    bool valid = json_is_object(object);
    json_decref(object);
    return valid ? WEFT_OK : weft_json_fail(error, code, "'%s': provenance is no JSON object", path);
}

weft_code weft_dataset_layout_check(const weft_dataset_layout *layout, const char *path, weft_code code,
                                    weft_error *error)
{
    WEFT_TRY(weft_dataset_layout_check_counts(layout, path, code, error));
    WEFT_TRY(check_places(layout, "light", layout->light, layout->image_count, path, code, error));
    WEFT_TRY(check_places(layout, "view", layout->view, layout->view_count, path, code, error));
    for (int i = 0; i < layout->image_count; i++) {
        int view = layout->view_of_image[i];
        if (view < 0 || view >= layout->view_count)
            return weft_fail(error, code, "'%s': image %d has view %d of %d", path, i, view, layout->view_count);
    }
    for (int i = 0; i < WEFT_IMAGE_FIGURES; i++)
        WEFT_TRY(weft_dataset_figure_check(layout, (weft_image_figure)i, path, code, error));
    return weft_dataset_provenance_check(layout->provenance, path, code, error);
}
