#include "tests/support/ground_truth.h"

#include "base/numeric/error_summary.h"

#include <hdf5.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- The file ---- */

static bool find_shape(hid_t file, const char *name, int rank, hsize_t *shape)
{
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    if (set < 0)
        return false;
    hid_t space = H5Dget_space(set);
    bool good = H5Sget_simple_extent_ndims(space) == rank && H5Sget_simple_extent_dims(space, shape, NULL) == rank;
    H5Sclose(space);
    H5Dclose(set);
    return good;
}

static bool load(hid_t file, const char *name, hid_t type, size_t count, void *values)
{
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    if (set < 0)
        return false;
    hid_t space = H5Dget_space(set);
    bool good = H5Sget_simple_extent_npoints(space) == (hssize_t)count &&
                H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    H5Sclose(space);
    H5Dclose(set);
    return good;
}

static bool load_number(hid_t file, const char *name, double *value)
{
    hid_t attribute = H5Aopen(file, name, H5P_DEFAULT);
    if (attribute < 0)
        return false;
    hid_t space = H5Aget_space(attribute);
    bool good = H5Sget_simple_extent_npoints(space) == 1 && H5Aread(attribute, H5T_NATIVE_DOUBLE, value) >= 0;
    H5Sclose(space);
    H5Aclose(attribute);
    return good;
}

static bool load_counts(hid_t file, truth *t)
{
    const hsize_t most = 1000000, most_texels = 4096;
    hsize_t rotation[3], light[2], reflectance[4];
    if (!find_shape(file, "rotation", 3, rotation) || !find_shape(file, "light_mm", 2, light) ||
        !find_shape(file, "reflectance", 4, reflectance))
        return false;
    if (rotation[0] > most || light[0] > most || reflectance[0] > light[0] || reflectance[1] > most_texels ||
        reflectance[1] < 1)
        return false;
    t->viewpoint_count = (int)rotation[0];
    t->shot_count = (int)light[0];
    t->image_count = (int)reflectance[0];
    t->size = (int)reflectance[1];
    return true;
}

static weft_code allocate(truth *t, weft_error *error)
{
    size_t values = (size_t)t->image_count * (size_t)t->size * (size_t)t->size;
    t->rotation = calloc((size_t)t->viewpoint_count, sizeof *t->rotation);
    t->translation_mm = calloc((size_t)t->viewpoint_count, sizeof *t->translation_mm);
    t->light_mm = calloc((size_t)t->shot_count, sizeof *t->light_mm);
    t->image_shot = calloc((size_t)t->image_count, sizeof *t->image_shot);
    t->reflectance = calloc(values, sizeof *t->reflectance);
    if (t->rotation && t->translation_mm && t->light_mm && t->image_shot && t->reflectance)
        return WEFT_OK;
    return weft_fail_memory(error, "ground truth", values * sizeof *t->reflectance);
}

static bool load_camera(hid_t file, weft_camera *camera)
{
    return load_number(file, "fx", &camera->fx) && load_number(file, "fy", &camera->fy) &&
           load_number(file, "cx", &camera->cx) && load_number(file, "cy", &camera->cy) &&
           load_number(file, "k1", &camera->k1) && load_number(file, "k2", &camera->k2);
}

static bool load_arrays(hid_t file, truth *t)
{
    size_t viewpoints = (size_t)t->viewpoint_count, images = (size_t)t->image_count, side = (size_t)t->size;
    bool good = load_camera(file, &t->camera) && load_number(file, "opening_mm", &t->opening_mm) &&
                load(file, "rotation", H5T_NATIVE_DOUBLE, viewpoints * 9, t->rotation) &&
                load(file, "translation_mm", H5T_NATIVE_DOUBLE, viewpoints * 3, t->translation_mm) &&
                load(file, "light_mm", H5T_NATIVE_DOUBLE, (size_t)t->shot_count * 3, t->light_mm) &&
                load(file, "image_shot", H5T_NATIVE_INT, images, t->image_shot) &&
                load(file, "reflectance", H5T_NATIVE_FLOAT, images * side * side * 3, t->reflectance);
    for (int image = 0; good && image < t->image_count; image++)
        good = t->image_shot[image] >= 0 && t->image_shot[image] < t->shot_count;
    return good;
}

weft_code truth_read(const char *path, truth *result, weft_error *error)
{
    *result = (truth){0};
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0)
        return weft_fail(error, WEFT_BAD_INPUT, "cannot open '%s' as an HDF5 file", path);
    weft_code code = WEFT_BAD_INPUT;
    if (!load_counts(file, result))
        weft_error_set(error, code, "'%s' holds no ground truth: its arrays are missing or have other shapes", path);
    else if ((code = allocate(result, error)) == WEFT_OK && !load_arrays(file, result))
        code = weft_fail(error, WEFT_BAD_INPUT, "the arrays or the camera of '%s' are damaged", path);
    H5Fclose(file);
    if (code != WEFT_OK)
        truth_free(result);
    return code;
}

void truth_free(truth *t)
{
    free(t->rotation);
    free(t->translation_mm);
    free(t->light_mm);
    free(t->image_shot);
    free(t->reflectance);
    *t = (truth){0};
}

/* ---- Places ---- */

double truth_warp_error_texels(const truth *t, const weft_camera *calibrated, int viewpoint,
                               const weft_homography *found, int texels)
{
    enum { grid = 9 };
    const double *place = t->translation_mm[viewpoint];
    weft_pose pose = {.translation = {place[0], place[1], place[2]}};
    memcpy(pose.rotation, t->rotation[viewpoint], sizeof pose.rotation);
    weft_homography real = weft_homography_of_pose(&t->camera, &pose);
    weft_homography inverse = weft_homography_inverse(found);
    double sum = 0;
    for (int i = 0; i < grid * grid; i++) {
        int column = i % grid, row = i / grid;
        double x = t->opening_mm * (column / (grid - 1.0) - 0.5), y = t->opening_mm * (row / (grid - 1.0) - 0.5);
        weft_pixel seen = weft_camera_distort(&t->camera, weft_homography_apply(&real, x, y));
        seen = weft_camera_undistort(calibrated, seen);
        weft_pixel back = weft_homography_apply(&inverse, seen.x, seen.y);
        sum += (back.x - x) * (back.x - x) + (back.y - y) * (back.y - y);
    }
    return sqrt(sum / (grid * grid)) / t->opening_mm * texels;
}

/* ---- Reflectance ---- */

/* Rows [first, first + rows) of a dataset. */
typedef struct strip {
    const weft_dataset_layout *layout;
    int first, rows;
    weft_half *samples;
    uint8_t *mask;
} strip;

/* Cosine of the far direction over that of the near light, at a texel. */
static double cosine_ratio(const truth *t, const strip *s, int shot, int x, int y)
{
    const double *light = t->light_mm[shot];
    double x_mm = ((x + 0.5) / t->size - 0.5) * t->opening_mm, y_mm = (0.5 - (y + 0.5) / t->size) * t->opening_mm;
    weft_vec3 near = weft_unit((weft_vec3){light[0] - x_mm, light[1] - y_mm, light[2]});
    return s->layout->light[shot].z / near.z;
}

static void compare_image(const truth *t, const strip *s, int image, truth_errors *errors)
{
    int shot = t->image_shot[image];
    size_t first = (size_t)image * (size_t)errors->capacity;
    for (int i = 0; i < s->rows * t->size; i++) {
        int x = i % t->size, y = s->first + i / t->size;
        size_t sample = (size_t)i * (size_t)s->layout->image_count + (size_t)shot;
        const float *reflectance =
            t->reflectance[((size_t)image * (size_t)t->size + (size_t)y) * (size_t)t->size + (size_t)x];
        double ratio = cosine_ratio(t, s, shot, x, y);
        bool is_border = x == 0 || y == 0 || x == t->size - 1 || y == t->size - 1;
        for (int c = 0; c < 3 && !s->mask[sample]; c++) {
            double expected = (double)reflectance[c] * ratio;
            double found = (double)weft_float_of_half(s->samples[3 * sample + (size_t)c]);
            if (!(reflectance[c] > errors->dim))
                continue;
            errors->error[first + (size_t)errors->count[image]++] = fabs(found / expected - 1);
            if (is_border)
                errors->border_error[first + (size_t)errors->border_count[image]++] = fabs(found / expected - 1);
        }
    }
}

/* The largest dim reflectance (base/numeric/error_summary.h). */
static float dim_limit(const truth *t)
{
    float largest = 0;
    for (size_t i = 0; i < 3 * (size_t)t->image_count * (size_t)t->size * (size_t)t->size; i++)
        largest = fmaxf(largest, t->reflectance[i / 3][i % 3]);
    return largest * (float)weft_dim_share;
}

static weft_code check_dataset(const truth *t, weft_dataset *dataset, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    if (layout->values != WEFT_REFLECTANCE_COSINE || layout->distance != WEFT_FAR)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' was not made by registration: its lights or values are of another kind",
                         weft_dataset_path(dataset));
    if (layout->width != t->size || layout->height != t->size || layout->image_count != t->shot_count)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d x %d texels and %d images, the truth %d x %d and %d",
                         weft_dataset_path(dataset), layout->width, layout->height, layout->image_count, t->size,
                         t->size, t->shot_count);
    return WEFT_OK;
}

static weft_code compare_strips(const truth *t, weft_dataset *dataset, strip *s, int rows, truth_errors *errors,
                                weft_error *error)
{
    for (s->first = 0; s->first < t->size; s->first += s->rows) {
        s->rows = t->size - s->first < rows ? t->size - s->first : rows;
        WEFT_TRY(weft_dataset_read_block(dataset, 0, s->first, t->size, s->rows, s->samples, s->mask, error));
        for (int image = 0; image < t->image_count; image++)
            compare_image(t, s, image, errors);
    }
    return WEFT_OK;
}

weft_code truth_compare_reflectance(const truth *t, weft_dataset *dataset, truth_errors *result, weft_error *error)
{
    return truth_compare_above(t, dataset, dim_limit(t), result, error);
}

weft_code truth_compare_above(const truth *t, weft_dataset *dataset, float dim, truth_errors *result, weft_error *error)
{
    enum { rows = 8 };
    *result = (truth_errors){.capacity = 3 * t->size * t->size, .dim = dim};
    WEFT_TRY(check_dataset(t, dataset, error));
    strip s = {.layout = weft_dataset_get_layout(dataset)};
    size_t samples = (size_t)rows * (size_t)t->size * (size_t)s.layout->image_count;
    s.samples = malloc(3 * samples * sizeof *s.samples);
    s.mask = malloc(samples);
    result->count = calloc((size_t)t->image_count, sizeof *result->count);
    result->border_count = calloc((size_t)t->image_count, sizeof *result->border_count);
    result->error = malloc((size_t)t->image_count * (size_t)result->capacity * sizeof *result->error);
    result->border_error = malloc((size_t)t->image_count * (size_t)result->capacity * sizeof *result->border_error);
    weft_code code = WEFT_OK;
    if (s.samples && s.mask && result->count && result->error && result->border_count && result->border_error)
        code = compare_strips(t, dataset, &s, rows, result, error);
    else
        code = weft_fail_memory(error, "rows of the dataset", 7 * samples);
    free(s.samples);
    free(s.mask);
    if (code != WEFT_OK)
        truth_errors_free(result);
    return code;
}

void truth_errors_free(truth_errors *errors)
{
    free(errors->count);
    free(errors->error);
    free(errors->border_count);
    free(errors->border_error);
    *errors = (truth_errors){0};
}
