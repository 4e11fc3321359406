#include "btf/dataset/create.h"

#include <fcntl.h>
#include <stdbool.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_CHUNK_SIDE = 64, MAX_CHUNK_BYTES = 1 << 22 };

/* Masks and opacities are smooth: the lowest level already takes nearly all there is to gain. */
static const unsigned deflate_level = 1;

static weft_code fail(const char *path, weft_error *error)
{
    return weft_fail(error, WEFT_SYSTEM, "cannot write '%s': %s", path, weft_hdf5_cause());
}

/* The smallest side that cuts `texels` into as few parts as `most` does. */
static int even_side(int texels, int most)
{
    int parts = (texels + most - 1) / most;
    return (texels + parts - 1) / parts;
}

void weft_dataset_chunk(const weft_dataset_layout *layout, int *width, int *height)
{
    size_t texel_bytes = (size_t)layout->image_count * 3 * sizeof(weft_half);
    int most = 1;
    while (2 * most <= MAX_CHUNK_SIDE && 4 * (size_t)(most * most) * texel_bytes <= MAX_CHUNK_BYTES)
        most *= 2;
    *width = even_side(layout->width, most);
    *height = even_side(layout->height, most);
}

/* ---- The empty file ---- */

static bool put_attribute(hid_t file, const char *name, hid_t type, const void *value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, type, value) >= 0;
    H5Aclose(attribute);
    H5Sclose(space);
    return done;
}

static hid_t text_type(size_t length)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length > 0 ? length : 1);
    H5Tset_cset(type, H5T_CSET_UTF8);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    return type;
}

static bool put_text(hid_t file, const char *name, const char *text)
{
    hid_t type = text_type(strlen(text));
    bool done = put_attribute(file, name, type, text);
    H5Tclose(type);
    return done;
}

/* 0 is what a reader takes for an attribute that is not there. */
static bool put_known_number(hid_t file, const char *name, double value)
{
    return value == 0 || put_attribute(file, name, H5T_NATIVE_DOUBLE, &value);
}

static bool put_attributes(hid_t file, const weft_dataset_layout *layout)
{
    const int version = WEFT_DATASET_VERSION;
    return put_text(file, "format", WEFT_DATASET_FORMAT) && put_attribute(file, "version", H5T_NATIVE_INT, &version) &&
           put_text(file, "values", weft_values_name[layout->values]) &&
           put_text(file, "distance", weft_distance_name[layout->distance]) &&
           put_text(file, "colour_space", WEFT_DATASET_COLOUR_SPACE) &&
           put_text(file, "saturated_samples", WEFT_DATASET_LOWER_BOUNDS) &&
           put_attribute(file, "texel_pitch_mm", H5T_NATIVE_DOUBLE, &layout->texel_pitch_mm) &&
           put_known_number(file, "texel_aspect", layout->texel_aspect) &&
           put_known_number(file, "plane_mm", layout->plane_mm);
}

/* How an object is created that does not store the second of its creation: the same content gives the same bytes. */
static hid_t creation_without_time(hid_t class)
{
    hid_t creation = H5Pcreate(class);
    H5Pset_obj_track_times(creation, false);
    return creation;
}

static hid_t create_array(hid_t file, const char *name, hid_t type, hid_t space)
{
    hid_t creation = creation_without_time(H5P_DATASET_CREATE);
    hid_t object = H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Pclose(creation);
    return object;
}

static bool put_array(hid_t file, const char *name, hid_t stored_type, hid_t type, int rank, const hsize_t *size,
                      const void *values)
{
    hid_t space = H5Screate_simple(rank, size, NULL);
    hid_t object = create_array(file, name, stored_type, space);
    bool done = object >= 0 && H5Dwrite(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    H5Dclose(object);
    H5Sclose(space);
    return done;
}

static bool put_directions(hid_t file, const weft_dataset_layout *layout)
{
    const hsize_t images[2] = {(hsize_t)layout->image_count, 3}, views[2] = {(hsize_t)layout->view_count, 3};
    return put_array(file, "light", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 2, images, layout->light) &&
           put_array(file, "view", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 2, views, layout->view) &&
           put_array(file, "view_of_image", H5T_STD_I32LE, H5T_NATIVE_INT32, 1, images, layout->view_of_image);
}

/* Per-texel data: [height][width][per_texel] and, for rank 4, [3]. Without a filter all chunks are given their place at
 * once, so that the size of the file is known before anything is written. Returns an identifier, negative on failure.
 */
static hid_t create_texels(hid_t file, const weft_dataset_layout *layout, const char *name, hid_t type, int rank,
                           int per_texel, bool is_deflated)
{
    int width, height;
    weft_dataset_chunk(layout, &width, &height);
    const hsize_t size[4] = {(hsize_t)layout->height, (hsize_t)layout->width, (hsize_t)per_texel, 3};
    const hsize_t chunk[4] = {(hsize_t)height, (hsize_t)width, (hsize_t)per_texel, 3};
    hid_t space = H5Screate_simple(rank, size, NULL), creation = creation_without_time(H5P_DATASET_CREATE);
    bool prepared = H5Pset_chunk(creation, rank, chunk) >= 0 && H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER) >= 0;
    if (is_deflated)
        prepared = prepared && H5Pset_deflate(creation, deflate_level) >= 0;
    else
        prepared = prepared && H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY) >= 0;
    hid_t object = H5I_INVALID_HID;
    if (prepared)
        object = H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Pclose(creation);
    H5Sclose(space);
    return object;
}

static bool put_texels(hid_t file, const weft_dataset_layout *layout)
{
    hid_t half = weft_hdf5_half_type();
    hid_t samples = create_texels(file, layout, "samples", half, 4, layout->image_count, false);
    hid_t mask = create_texels(file, layout, "mask", H5T_STD_U8LE, 3, layout->image_count, true);
    bool done = samples >= 0 && mask >= 0;
    H5Dclose(samples);
    H5Dclose(mask);
    H5Tclose(half);
    return done;
}

/* The 1.10 format has checksums on its metadata; older ones let a flipped bit pass. */
static hid_t file_access(void)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    return access;
}

static weft_code reserve(const char *temporary_path, const char *path, weft_error *error)
{
    struct stat status;
    int descriptor = open(temporary_path, O_RDWR | O_CLOEXEC);
    if (descriptor < 0 || fstat(descriptor, &status) != 0) {
        close(descriptor);
        return weft_fail_errno(error, "write", path);
    }
    int failure = posix_fallocate(descriptor, 0, status.st_size);
    close(descriptor);
    if (failure != 0)
        return weft_fail(error, WEFT_SYSTEM, "cannot reserve %lld bytes for '%s': %s", (long long)status.st_size, path,
                         strerror(failure));
    return WEFT_OK;
}

weft_code weft_dataset_create(const char *temporary_path, const char *path, const weft_dataset_layout *layout,
                              weft_error *error)
{
    weft_hdf5_quiet();
    hid_t access = file_access(), creation = creation_without_time(H5P_FILE_CREATE);
    hid_t file = H5Fcreate(temporary_path, H5F_ACC_TRUNC, creation, access);
    H5Pclose(creation);
    H5Pclose(access);
    if (file < 0)
        return fail(path, error);
    bool done = put_attributes(file, layout) && put_directions(file, layout) && put_texels(file, layout);
    weft_code code = done ? WEFT_OK : fail(path, error);
    if (H5Fclose(file) < 0 && code == WEFT_OK)
        code = fail(path, error);
    return code == WEFT_OK ? reserve(temporary_path, path, error) : code;
}

/* ---- Filling it ---- */

weft_code weft_dataset_file_open(const char *temporary_path, const char *path, weft_dataset_file *file,
                                 weft_error *error)
{
    weft_hdf5_quiet();
    hid_t access = file_access();
    *file = (weft_dataset_file){.path = path, .file = H5Fopen(temporary_path, H5F_ACC_RDWR, access)};
    H5Pclose(access);
    file->half = weft_hdf5_half_type();
    file->samples = H5Dopen2(file->file, "samples", H5P_DEFAULT);
    file->mask = H5Dopen2(file->file, "mask", H5P_DEFAULT);
    if (file->file >= 0 && file->half >= 0 && file->samples >= 0 && file->mask >= 0)
        return WEFT_OK;
    weft_code code = fail(path, error);
    weft_dataset_file_close(file, NULL);
    return code;
}

static bool write_slab(hid_t object, int rank, const hsize_t *start, const hsize_t *count, hid_t type,
                       const void *values)
{
    hid_t space = H5Dget_space(object), memory = H5Screate_simple(rank, count, NULL);
    bool done = space >= 0 && memory >= 0 &&
                H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
                H5Dwrite(object, type, memory, space, H5P_DEFAULT, values) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    return done;
}

weft_code weft_dataset_file_write(const weft_dataset_file *file, const weft_dataset_layout *layout, int x, int y,
                                  int width, int height, const weft_half *samples, const uint8_t *mask,
                                  weft_error *error)
{
    const hsize_t start[4] = {(hsize_t)y, (hsize_t)x, 0, 0};
    const hsize_t count[4] = {(hsize_t)height, (hsize_t)width, (hsize_t)layout->image_count, 3};
    bool done = write_slab(file->samples, 4, start, count, file->half, samples) &&
                write_slab(file->mask, 3, start, count, H5T_NATIVE_UINT8, mask);
    return done ? WEFT_OK : fail(file->path, error);
}

static weft_code write_floats(const weft_dataset_file *file, const weft_dataset_layout *layout, const char *name,
                              int rank, int per_texel, const float *values, weft_error *error)
{
    hid_t object = create_texels(file->file, layout, name, H5T_IEEE_F32LE, rank, per_texel, true);
    bool done = object >= 0 && H5Dwrite(object, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    weft_code code = done ? WEFT_OK : fail(file->path, error);
    H5Dclose(object);
    return code;
}

weft_code weft_dataset_file_write_opacity(const weft_dataset_file *file, const weft_dataset_layout *layout,
                                          const float *opacity, weft_error *error)
{
    return write_floats(file, layout, "opacity", 3, layout->view_count, opacity, error);
}

weft_code weft_dataset_file_write_frames(const weft_dataset_file *file, const weft_dataset_layout *layout,
                                         const float *frames, weft_error *error)
{
    return write_floats(file, layout, "frame", 4, 2, frames, error);
}

weft_code weft_dataset_file_write_figures(const weft_dataset_file *file, const weft_dataset_layout *layout,
                                          weft_error *error)
{
    const hsize_t images = (hsize_t)layout->image_count;
    bool done = true;
    for (int i = 0; i < WEFT_IMAGE_FIGURES; i++) {
        if (layout->figure[i])
            done = done && put_array(file->file, weft_image_figure_name[i], H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 1,
                                     &images, layout->figure[i]);
    }
    return done ? WEFT_OK : fail(file->path, error);
}

static bool drop_attribute(hid_t file, const char *name)
{
    return H5Aexists(file, name) == 0 || H5Adelete(file, name) >= 0;
}

static bool drop(hid_t file, const char *name)
{
    return H5Lexists(file, name, H5P_DEFAULT) == 0 || H5Ldelete(file, name, H5P_DEFAULT) >= 0;
}

static bool put_heights(hid_t file, const weft_dataset_heights *heights)
{
    const hsize_t size[2] = {(hsize_t)heights->height, (hsize_t)heights->width};
    return put_array(file, "height", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, 2, size, heights->value) &&
           put_attribute(file, "height_levels", H5T_NATIVE_INT, &heights->level_count);
}

weft_code weft_dataset_file_write_relief(const weft_dataset_file *file, double plane_mm,
                                         const weft_dataset_heights *heights, weft_error *error)
{
    bool done = drop_attribute(file->file, "plane_mm") && drop_attribute(file->file, "height_levels") &&
                drop(file->file, "height") && put_known_number(file->file, "plane_mm", plane_mm) &&
                (!heights || put_heights(file->file, heights));
    return done ? WEFT_OK : fail(file->path, error);
}

weft_code weft_dataset_file_write_provenance(const weft_dataset_file *file, const char *text, weft_error *error)
{
    if (!drop(file->file, "provenance"))
        return fail(file->path, error);
    hid_t type = text_type(strlen(text)), space = H5Screate(H5S_SCALAR);
    hid_t object = create_array(file->file, "provenance", type, space);
    bool done = object >= 0 && H5Dwrite(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
    weft_code code = done ? WEFT_OK : fail(file->path, error);
    H5Dclose(object);
    H5Sclose(space);
    H5Tclose(type);
    return code;
}

weft_code weft_dataset_file_close(weft_dataset_file *file, weft_error *error)
{
    bool done = true;
    if (file->samples >= 0)
        done &= H5Dclose(file->samples) >= 0;
    if (file->mask >= 0)
        done &= H5Dclose(file->mask) >= 0;
    if (file->half >= 0)
        H5Tclose(file->half);
    if (file->file >= 0)
        done &= H5Fclose(file->file) >= 0;
    weft_code code = done ? WEFT_OK : fail(file->path, error);
    file->samples = file->mask = file->half = file->file = H5I_INVALID_HID;
    return code;
}
