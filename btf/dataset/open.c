#include "base/atomic_file.h"
#include "btf/dataset/hdf5.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A dataset may claim at most so many times the bytes of its file: room for any filter, not for a bomb. */
static const uint64_t largest_ratio = 1024;

enum { MAX_NAME = 64, MAX_PROVENANCE = 1 << 24, MAX_LEVELS = 32 };

/* Three reals in HDF5 are three in memory. */
_Static_assert(sizeof(weft_vec3) == 3 * sizeof(double), "places are read as doubles");

static weft_code fail(const weft_dataset *dataset, weft_error *error, const char *what, const char *name)
{
    const char *cause = weft_hdf5_cause();
    return weft_fail(error, WEFT_BAD_INPUT, "'%s': %s '%s'%s%s", dataset->path, what, name, cause[0] ? ": " : "",
                     cause);
}

/* ---- Attributes and strings ---- */

/* The whole of an attribute or of a dataset: strings come as either. */
typedef herr_t read_function(hid_t object, hid_t memory_type, void *buffer);

static herr_t read_attribute(hid_t object, hid_t memory_type, void *buffer)
{
    return H5Aread(object, memory_type, buffer);
}

static herr_t read_whole_dataset(hid_t object, hid_t memory_type, void *buffer)
{
    return H5Dread(object, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
}

/* Whether a space and a type are those of a single value of a class. */
static bool is_one(hid_t space, hid_t type, H5T_class_t class)
{
    return space >= 0 && type >= 0 && H5Sget_simple_extent_npoints(space) == 1 && H5Tget_class(type) == class;
}

/* The memory type of a string is the file's own, so that character sets and padding agree. NULL on failure, with ENOMEM
 * in errno where memory is short. */
static char *read_string(hid_t object, hid_t type, read_function *read)
{
    errno = 0;
    char *text = NULL;
    if (H5Tis_variable_str(type) > 0) {
        char *owned_by_hdf5 = NULL;
        if (read(object, type, &owned_by_hdf5) >= 0 && owned_by_hdf5)
            text = strdup(owned_by_hdf5);
        H5free_memory(owned_by_hdf5);
        return text;
    }
    size_t size = H5Tget_size(type);
    if (size < 1 || size > MAX_PROVENANCE)
        return NULL;
    text = calloc(1, size + 1);
    if (text && read(object, type, text) < 0) {
        free(text);
        return NULL;
    }
    return text;
}

static weft_code open_attribute(const weft_dataset *dataset, const char *name, hid_t *attribute, weft_error *error)
{
    if (H5Aexists(dataset->file, name) == 0)
        return fail(dataset, error, "has no attribute", name);
    *attribute = H5Aopen(dataset->file, name, H5P_DEFAULT);
    return *attribute >= 0 ? WEFT_OK : fail(dataset, error, "cannot open attribute", name);
}

static weft_code read_text_attribute(const weft_dataset *dataset, const char *name, char text[MAX_NAME],
                                     weft_error *error)
{
    hid_t attribute = H5I_INVALID_HID;
    WEFT_TRY(open_attribute(dataset, name, &attribute, error));
    hid_t space = H5Aget_space(attribute), type = H5Aget_type(attribute);
    char *value = NULL;
    weft_code code = WEFT_OK;
    if (!is_one(space, type, H5T_STRING))
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s': attribute '%s' is not one string", dataset->path, name);
    else if ((value = read_string(attribute, type, read_attribute)) && strlen(value) < MAX_NAME)
        snprintf(text, MAX_NAME, "%s", value);
    else if (!value && errno == ENOMEM)
        code = weft_fail_memory(error, name, MAX_NAME);
    else
        code = fail(dataset, error, "cannot read attribute", name);
    free(value);
    H5Tclose(type);
    H5Sclose(space);
    H5Aclose(attribute);
    return code;
}

static weft_code read_number_attribute(const weft_dataset *dataset, const char *name, double *value, weft_error *error)
{
    hid_t attribute = H5I_INVALID_HID;
    WEFT_TRY(open_attribute(dataset, name, &attribute, error));
    hid_t space = H5Aget_space(attribute), type = H5Aget_type(attribute);
    weft_code code = WEFT_OK;
    if (!is_one(space, type, H5T_FLOAT) && !is_one(space, type, H5T_INTEGER))
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s': attribute '%s' is not one number", dataset->path, name);
    else if (H5Aread(attribute, H5T_NATIVE_DOUBLE, value) < 0)
        code = fail(dataset, error, "cannot read attribute", name);
    H5Tclose(type);
    H5Sclose(space);
    H5Aclose(attribute);
    return code;
}

/* A number that a file may lack: `value` stays then. */
static weft_code read_optional_number(const weft_dataset *dataset, const char *name, double *value, weft_error *error)
{
    return H5Aexists(dataset->file, name) == 0 ? WEFT_OK : read_number_attribute(dataset, name, value, error);
}

static weft_code check_colour_space(const weft_dataset *dataset, weft_error *error)
{
    char text[MAX_NAME];
    WEFT_TRY(read_text_attribute(dataset, "colour_space", text, error));
    if (strcmp(text, WEFT_DATASET_COLOUR_SPACE) != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': attribute 'colour_space' is '%s', must be '%s'", dataset->path,
                         text, WEFT_DATASET_COLOUR_SPACE);
    return WEFT_OK;
}

/* Files of others, and of Weft before 0.2, do not say what saturated samples are. */
static weft_code find_bounds(weft_dataset *dataset, weft_error *error)
{
    char text[MAX_NAME];
    if (H5Aexists(dataset->file, "saturated_samples") <= 0)
        return WEFT_OK;
    WEFT_TRY(read_text_attribute(dataset, "saturated_samples", text, error));
    dataset->has_bounds = strcmp(text, WEFT_DATASET_LOWER_BOUNDS) == 0;
    return WEFT_OK;
}

/* Index of the attribute's text among two names. */
static weft_code read_choice(const weft_dataset *dataset, const char *name, const char *const choice[2], int *index,
                             weft_error *error)
{
    char text[MAX_NAME];
    WEFT_TRY(read_text_attribute(dataset, name, text, error));
    for (*index = 0; *index < 2; (*index)++) {
        if (strcmp(text, choice[*index]) == 0)
            return WEFT_OK;
    }
    return weft_fail(error, WEFT_BAD_INPUT, "'%s': attribute '%s' is '%s', must be '%s' or '%s'", dataset->path, name,
                     text, choice[0], choice[1]);
}

static weft_code read_attributes(weft_dataset *dataset, weft_error *error)
{
    char format[MAX_NAME];
    double version;
    int values, distance;
    WEFT_TRY(read_text_attribute(dataset, "format", format, error));
    WEFT_TRY(read_number_attribute(dataset, "version", &version, error));
    if (strcmp(format, WEFT_DATASET_FORMAT) != 0 || version != WEFT_DATASET_VERSION)
        return weft_fail(error, WEFT_NOT_SUPPORTED,
                         "'%s' has format '%s' version %g, this program reads '%s' version %d", dataset->path, format,
                         version, WEFT_DATASET_FORMAT, WEFT_DATASET_VERSION);
    WEFT_TRY(read_choice(dataset, "values", weft_values_name, &values, error));
    WEFT_TRY(read_choice(dataset, "distance", weft_distance_name, &distance, error));
    dataset->layout.values = (weft_values)values;
    dataset->layout.distance = (weft_distance)distance;
    WEFT_TRY(check_colour_space(dataset, error));
    WEFT_TRY(find_bounds(dataset, error));
    WEFT_TRY(read_number_attribute(dataset, "texel_pitch_mm", &dataset->layout.texel_pitch_mm, error));
    WEFT_TRY(read_optional_number(dataset, "texel_aspect", &dataset->layout.texel_aspect, error));
    return read_optional_number(dataset, "plane_mm", &dataset->layout.plane_mm, error);
}

/* ---- Datasets ---- */

/* Opens a dataset of numbers with `rank` dimensions. */
static weft_code open_array(const weft_dataset *dataset, const char *name, int rank, hsize_t *size, hid_t *object,
                            weft_error *error)
{
    *object = H5I_INVALID_HID;
    if (H5Lexists(dataset->file, name, H5P_DEFAULT) == 0)
        return fail(dataset, error, "has no dataset", name);
    *object = weft_hdf5_open_cached(dataset->file, name);
    if (*object < 0)
        return fail(dataset, error, "cannot open", name);
    hid_t space = H5Dget_space(*object), type = H5Dget_type(*object);
    H5T_class_t class = H5Tget_class(type);
    int found = space < 0 ? -1 : H5Sget_simple_extent_ndims(space);
    if (found == rank)
        H5Sget_simple_extent_dims(space, size, NULL);
    H5Tclose(type);
    H5Sclose(space);
    if (class != H5T_FLOAT && class != H5T_INTEGER)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': '%s' holds no numbers", dataset->path, name);
    if (found != rank)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': '%s' must be a numeric array of %d dimensions; it has %d",
                         dataset->path, name, rank, found);
    return WEFT_OK;
}

static weft_code check_size(const weft_dataset *dataset, const char *name, int rank, const hsize_t *size,
                            const hsize_t *expected, weft_error *error)
{
    for (int i = 0; i < rank; i++) {
        if (size[i] != expected[i])
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': dimension %d of '%s' is %llu, must be %llu", dataset->path,
                             i, name, (unsigned long long)size[i], (unsigned long long)expected[i]);
    }
    return WEFT_OK;
}

static int limited_int(hsize_t size)
{
    return size > INT32_MAX ? INT32_MAX : (int)size;
}

/* Leaves *object alone where there is none. */
static weft_code open_optional(const weft_dataset *dataset, const char *name, int rank, const hsize_t *expected,
                               hid_t *object, weft_error *error)
{
    hsize_t size[4];
    if (H5Lexists(dataset->file, name, H5P_DEFAULT) <= 0)
        return WEFT_OK;
    WEFT_TRY(open_array(dataset, name, rank, size, object, error));
    return check_size(dataset, name, rank, size, expected, error);
}

/* Their size is the reader's to know; that it fits the texels is checked with the values. */
static weft_code open_heights(weft_dataset *dataset, weft_error *error)
{
    hsize_t size[2] = {0};
    double levels = 1;
    if (H5Lexists(dataset->file, "height", H5P_DEFAULT) <= 0)
        return WEFT_OK;
    WEFT_TRY(open_array(dataset, "height", 2, size, &dataset->heights, error));
    WEFT_TRY(read_optional_number(dataset, "height_levels", &levels, error));
    dataset->heights_height = limited_int(size[0]);
    dataset->heights_width = limited_int(size[1]);
    dataset->heights_levels = levels >= 1 && levels <= MAX_LEVELS ? (int)levels : 0;
    const weft_dataset_heights heights = {dataset->heights_width, dataset->heights_height, dataset->heights_levels,
                                          NULL};
    return weft_dataset_heights_check(&dataset->layout, &heights, dataset->path, WEFT_BAD_INPUT, error);
}

static weft_code open_texels(weft_dataset *dataset, weft_error *error)
{
    weft_dataset_layout *layout = &dataset->layout;
    hsize_t samples[4], mask[3];
    WEFT_TRY(open_array(dataset, "samples", 4, samples, &dataset->samples, error));
    WEFT_TRY(open_array(dataset, "mask", 3, mask, &dataset->mask, error));
    WEFT_TRY(check_size(dataset, "mask", 3, mask, samples, error));
    WEFT_TRY(check_size(dataset, "samples", 4, samples, (hsize_t[]){samples[0], samples[1], samples[2], 3}, error));
    layout->height = limited_int(samples[0]);
    layout->width = limited_int(samples[1]);
    layout->image_count = limited_int(samples[2]);
    WEFT_TRY(weft_dataset_layout_check_counts(layout, dataset->path, WEFT_BAD_INPUT, error));
    WEFT_TRY(open_optional(dataset, "opacity", 3, (hsize_t[]){samples[0], samples[1], (hsize_t)layout->view_count},
                           &dataset->opacity, error));
    WEFT_TRY(open_optional(dataset, "frame", 4, (hsize_t[]){samples[0], samples[1], 2, 3}, &dataset->frames, error));
    return open_heights(dataset, error);
}

static weft_code open_view_count(weft_dataset *dataset, weft_error *error)
{
    hsize_t view[2];
    hid_t object;
    weft_code code = open_array(dataset, "view", 2, view, &object, error);
    H5Dclose(object);
    WEFT_TRY(code);
    dataset->layout.view_count = limited_int(view[0]);
    return WEFT_OK;
}

/* So that nothing is allocated that the file cannot hold. */
static weft_code check_plausible(const weft_dataset *dataset, weft_error *error)
{
    const weft_dataset_layout *layout = &dataset->layout;
    uint64_t most = dataset->file_size * largest_ratio;
    uint64_t texels = (uint64_t)layout->width * (uint64_t)layout->height;
    uint64_t views = (uint64_t)layout->view_count;
    if (texels * (uint64_t)layout->image_count > most || views > most ||
        (dataset->opacity >= 0 && texels * views > most))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' has %llu bytes, too few for %d x %d texels, %d images and %d views", dataset->path,
                         (unsigned long long)dataset->file_size, layout->width, layout->height, layout->image_count,
                         layout->view_count);
    return WEFT_OK;
}

static weft_code read_array(const weft_dataset *dataset, const char *name, int rank, const hsize_t *expected,
                            hid_t memory_type, void *buffer, weft_error *error)
{
    hsize_t size[2];
    hid_t object;
    weft_code code = open_array(dataset, name, rank, size, &object, error);
    if (code == WEFT_OK)
        code = check_size(dataset, name, rank, size, expected, error);
    if (code == WEFT_OK && H5Dread(object, memory_type, H5S_ALL, H5S_ALL, dataset->transfer, buffer) < 0)
        code = fail(dataset, error, "cannot read", name);
    H5Dclose(object);
    return code;
}

/* A file may hold none of them. */
static weft_code read_figures(weft_dataset *dataset, weft_error *error)
{
    weft_dataset_layout *layout = &dataset->layout;
    const hsize_t images = (hsize_t)layout->image_count;
    for (int i = 0; i < WEFT_IMAGE_FIGURES; i++) {
        const char *name = weft_image_figure_name[i];
        if (H5Lexists(dataset->file, name, H5P_DEFAULT) <= 0)
            continue;
        WEFT_TRY(weft_dataset_layout_allocate_figure(layout, (weft_image_figure)i, error));
        WEFT_TRY(read_array(dataset, name, 1, &images, H5T_NATIVE_DOUBLE, layout->figure[i], error));
    }
    return WEFT_OK;
}

static weft_code read_provenance(weft_dataset *dataset, weft_error *error)
{
    if (H5Lexists(dataset->file, "provenance", H5P_DEFAULT) == 0)
        return fail(dataset, error, "has no dataset", "provenance");
    hid_t object = H5Dopen2(dataset->file, "provenance", H5P_DEFAULT);
    if (object < 0)
        return fail(dataset, error, "cannot open", "provenance");
    hid_t space = H5Dget_space(object), type = H5Dget_type(object);
    char *text = NULL;
    weft_code code = WEFT_OK;
    if (!is_one(space, type, H5T_STRING))
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s': 'provenance' is not one string", dataset->path);
    else if (!(text = read_string(object, type, read_whole_dataset)))
        code = errno == ENOMEM ? weft_fail_memory(error, "provenance", MAX_PROVENANCE)
                               : fail(dataset, error, "cannot read", "provenance");
    H5Tclose(type);
    H5Sclose(space);
    H5Dclose(object);
    if (text) {
        free(dataset->layout.provenance);
        dataset->layout.provenance = text;
    }
    return code;
}

static void normalise(weft_vec3 *direction, int count)
{
    for (int i = 0; i < count; i++)
        direction[i] = weft_unit(direction[i]);
}

static weft_code read_layout(weft_dataset *dataset, weft_error *error)
{
    weft_dataset_layout *layout = &dataset->layout;
    WEFT_TRY(read_attributes(dataset, error));
    WEFT_TRY(open_view_count(dataset, error));
    WEFT_TRY(open_texels(dataset, error));
    WEFT_TRY(check_plausible(dataset, error));
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    const hsize_t images[2] = {(hsize_t)layout->image_count, 3}, views[2] = {(hsize_t)layout->view_count, 3};
    WEFT_TRY(read_array(dataset, "light", 2, images, H5T_NATIVE_DOUBLE, layout->light, error));
    WEFT_TRY(read_array(dataset, "view", 2, views, H5T_NATIVE_DOUBLE, layout->view, error));
    WEFT_TRY(read_array(dataset, "view_of_image", 1, images, H5T_NATIVE_INT32, layout->view_of_image, error));
    WEFT_TRY(read_figures(dataset, error));
    WEFT_TRY(read_provenance(dataset, error));
    WEFT_TRY(weft_dataset_layout_check(layout, dataset->path, WEFT_BAD_INPUT, error));
    if (layout->distance == WEFT_FAR) {
        normalise(layout->light, layout->image_count);
        normalise(layout->view, layout->view_count);
    }
    return WEFT_OK;
}

/* Whether the file begins as a material does. */
static bool is_material(const char *path)
{
    static const char magic[5] = {(char)0x89, 'W', 'E', 'F', 'T'};
    char head[sizeof magic] = "";
    FILE *file = fopen(path, "rb");
    bool found = file && fread(head, sizeof head, 1, file) == 1 && memcmp(head, magic, sizeof magic) == 0;
    if (file)
        fclose(file);
    return found;
}

static weft_code open_file(weft_dataset *dataset, weft_error *error)
{
    struct stat status;
    if (stat(dataset->path, &status) != 0)
        return weft_fail_reading(error, "open", dataset->path);
    if (!S_ISREG(status.st_mode))
        return weft_fail(error, WEFT_BAD_INPUT, "cannot open '%s': not a regular file", dataset->path);
    if (is_material(dataset->path))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is a material; a dataset (NAME.btf.h5) is needed here",
                         dataset->path);
    dataset->file_size = (uint64_t)status.st_size;
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    dataset->file = H5Fopen(dataset->path, H5F_ACC_RDONLY, access);
    /* Any other call would forget the cause. */
    const char *cause = weft_hdf5_cause();
    H5Pclose(access);
    if (dataset->file < 0)
        return weft_fail(error, WEFT_DAMAGED, "cannot open '%s' as HDF5 (%llu bytes): %s", dataset->path,
                         (unsigned long long)dataset->file_size, cause);
    dataset->half = weft_hdf5_half_type();
    dataset->transfer = weft_hdf5_whole_transfer();
    if (dataset->half < 0 || dataset->transfer < 0)
        return weft_fail(error, WEFT_SYSTEM, "HDF5 cannot make a half float type or a property list");
    return WEFT_OK;
}

weft_code weft_dataset_open(const char *path, weft_dataset **result, weft_error *error)
{
    *result = NULL;
    weft_hdf5_quiet();
    weft_dataset *dataset = calloc(1, sizeof *dataset);
    if (!dataset)
        return weft_fail_memory(error, "dataset", sizeof *dataset);
    dataset->file = dataset->half = dataset->transfer = H5I_INVALID_HID;
    dataset->samples = dataset->mask = H5I_INVALID_HID;
    dataset->opacity = dataset->frames = dataset->heights = H5I_INVALID_HID;
    dataset->path = strdup(path);
    weft_code code = dataset->path ? WEFT_OK : weft_fail_memory(error, "path", strlen(path));
    if (code == WEFT_OK)
        code = open_file(dataset, error);
    if (code == WEFT_OK)
        code = read_layout(dataset, error);
    if (code == WEFT_OK)
        *result = dataset;
    else
        weft_dataset_close(dataset);
    return code;
}

void weft_dataset_close(weft_dataset *dataset)
{
    if (!dataset)
        return;
    /* The file closes its datasets with it. */
    if (dataset->file >= 0)
        H5Fclose(dataset->file);
    if (dataset->half >= 0)
        H5Tclose(dataset->half);
    if (dataset->transfer >= 0)
        H5Pclose(dataset->transfer);
    weft_dataset_layout_free(&dataset->layout);
    free(dataset->path);
    free(dataset);
}

const weft_dataset_layout *weft_dataset_get_layout(const weft_dataset *dataset)
{
    return &dataset->layout;
}

const char *weft_dataset_path(const weft_dataset *dataset)
{
    return dataset->path;
}
